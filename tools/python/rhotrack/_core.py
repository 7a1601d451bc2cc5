# SPDX-License-Identifier: MIT
"""What all parts share: the C below, errors, and C structs as numpy types."""
from __future__ import annotations

import functools
import threading
from typing import Any, Callable, TypeVar

import numpy as np

from ._native import ffi, lib

NULL = ffi.NULL


class Error(ValueError):
    """A value, field, file or line that is refused; the message names it."""


def must(result: Any) -> Any:
    """The result of a call of python_interface.h; where it failed, an exception with
    its message."""
    if result:
        return result
    is_usage = ffi.new("bool *")
    message = ffi.string(lib.program_last_failure(is_usage)).decode(errors="replace")
    raise (Error if is_usage[0] else RuntimeError)(message)


def must_succeed(status: int, what: str) -> None:
    """Raises Error for a status of the library that is not RHO_OK."""
    if status != lib.RHO_OK:
        name = ffi.string(lib.rho_status_name(status)).decode()
        raise Error(f"{what}: the library refuses it: {name}")


class Shared:
    """An object of C, which no two threads may use at a time; its calls in_turn wait for one
    another."""
    _turn: Any

    def __new__(cls, *given: Any, **named: Any) -> Any:
        self = super().__new__(cls)
        self._turn = threading.RLock()
        return self


Call = TypeVar("Call", bound=Callable[..., Any])


def in_turn(call: Call) -> Call:
    """A method of a Shared, which waits until no other thread is in one."""
    @functools.wraps(call)
    def wait(self: Shared, *given: Any, **named: Any) -> Any:
        with self._turn:
            return call(self, *given, **named)
    return wait  # type: ignore[return-value]


FORMATS = {"double": "f8", "float": "f4", "int32_t": "i4", "uint32_t": "u4", "int16_t": "i2",
           "uint16_t": "u2", "uint8_t": "u1", "int64_t": "i8", "int": "i4"}


def dtype_of(struct: str) -> np.dtype:
    """The numpy type of a flat C struct; uint32_t[N] is text."""
    fields = ffi.typeof(f"struct {struct}").fields
    return np.dtype({
        "names": [name for name, _ in fields],
        "formats": [f"U{field.type.length}" if field.type.kind == "array"
                    else FORMATS[field.type.cname] for _, field in fields],
        "offsets": [field.offset for _, field in fields],
        "itemsize": ffi.sizeof(f"struct {struct}")})


def array_of(pointer: Any, count: int, dtype: Any) -> np.ndarray:
    """A copy of C memory."""
    dtype = np.dtype(dtype)
    if count == 0:
        return np.empty(0, dtype)
    return np.frombuffer(ffi.buffer(pointer, count * dtype.itemsize), dtype).copy()


def pointer_to(array: np.ndarray, ctype: str) -> Any:
    """The memory of an array, which must outlive the pointer. C knows nothing of strides."""
    if not array.flags.c_contiguous or array.itemsize != ffi.sizeof(ffi.typeof(ctype).item):
        raise Error(f"an array of {array.dtype} in strides of {array.strides} is no {ctype}")
    return ffi.cast(ctype, ffi.from_buffer(array))


def plain(value: Any) -> Any:
    """A C number as it is, an array as numpy has it, a struct as a dictionary."""
    if not isinstance(value, ffi.CData):
        return value
    ctype = ffi.typeof(value)
    if ctype.kind == "array":
        return np.array([plain(one) for one in value])
    return {name: plain(getattr(value, name)) for name, _ in ctype.fields}


def names_of(function: Any, count: int) -> np.ndarray:
    """The names of an enumeration of C."""
    return np.array([ffi.string(function(i)).decode() for i in range(count)])


FATES = names_of(lib.rho_fate_name, lib.RHO_NUM_FATES)
