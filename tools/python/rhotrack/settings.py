# SPDX-License-Identifier: MIT
"""Parameters of the tracker, the initiators and the readers."""
from __future__ import annotations

import os
from typing import Any, Iterator

from ._core import NULL, Error, ffi, lib, must


PRESETS = ("en_route", "approach", "marine", "coastal_harbour", "drone_defence", "traffic")


class Settings:
    """All parameters of `rhotrack config`, by their names.

    Settings("radar.ini", sigma_m=5, gate="nearest") reads INI files, then sets single parameters;
    these win. settings.v_max_mps = 300 sets another one, settings.sensor(2, pd=0.8) those of one
    sensor. An attribute is a float, a word, or None where nothing is set. Units are in the names;
    help(rhotrack.parameters) tells how to list ranges and defaults.
    """

    def __init__(self, *files: str | os.PathLike, **parameters: Any) -> None:
        object.__setattr__(self, "handle", _handle(NULL))
        for file in files:
            must(lib.program_settings_load(self.handle, os.fsencode(file)))
        for name, value in parameters.items():
            self[name] = value
        self.check()

    @classmethod
    def preset(cls, kind: str, **parameters: Any) -> Settings:
        """Those of a kind of radar, to begin with: "en_route", "approach", "marine",
        "coastal_harbour", "drone_defence" or "traffic" (rhotrack/settings.h has the table; the
        interval of the scans, which says how rows of a file are grouped, is not set)."""
        if kind not in PRESETS:
            raise Error(f"preset {kind!r} is none of {', '.join(PRESETS)}")
        of_kind = ffi.new("struct rho_settings *")
        lib.rho_settings_preset(of_kind, getattr(lib, f"RHO_PRESET_{kind.upper()}"))
        known = [ffi.string(one.name).decode() for one in _parameters(_handle(NULL))]
        return cls(**{**{name: float(f"{getattr(of_kind, name):.7g}")
                         for name, _ in ffi.typeof(of_kind[0]).fields
                         if name in known and name not in ("scan_interval_s", "standing")},
                      "standing": ("clutter", "targets")[of_kind.standing], **parameters})

    def check(self) -> None:
        """Raises Error where parameters contradict one another, as v_min_mps above v_max_mps."""
        must(lib.program_settings_check(self.handle))

    def copy(self, **parameters: Any) -> Settings:
        """The same settings with some parameters set anew."""
        other = Settings.__new__(Settings)
        object.__setattr__(other, "handle", _handle(self.handle))
        for name, value in parameters.items():
            other[name] = value
        other.check()
        return other

    def sensor(self, sensor_id: int, **parameters: Any) -> None:
        """Sets what is known of one sensor: pd, sigmas, range limits, sector, biases, place."""
        for name, value in parameters.items():
            self[f"sensor.{sensor_id}.{name}"] = value

    def __setitem__(self, name: str, value: Any) -> None:
        must(lib.program_settings_set(self.handle, name.encode(), _text(value).encode()))

    def __getitem__(self, name: str) -> float | str | None:
        for parameter in _parameters(self.handle):
            if ffi.string(parameter.name).decode() == name:
                text = ffi.string(parameter.value).decode()
                return None if not text else float(text) if parameter.is_number else text
        raise Error(f"there is no parameter {name}")

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __getattr__(self, name: str) -> float | str | None:
        try:
            return self[name]
        except Error as error:
            raise AttributeError(str(error)) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *parameters()]

    def __repr__(self) -> str:
        told = [f"{name}={self[name]!r}" for name, one in parameters(self).items()
                if one["value"] != one["initial"]]
        return f"Settings({', '.join(told)})"


def parameters(settings: Settings | None = None) -> dict[str, dict[str, Any]]:
    """Every parameter: unit, text, min, max, choices, and initial and present value as text."""
    handle = settings.handle if settings else _handle(NULL)
    return {
        ffi.string(one.name).decode(): {
            "unit": ffi.string(one.unit).decode(), "text": ffi.string(one.text).decode(),
            "min": one.min, "max": one.max, "choices": ffi.string(one.range).decode(),
            "initial": ffi.string(one.initial).decode(), "value": ffi.string(one.value).decode()}
        for one in _parameters(handle)}


def settings_of(settings: Settings | None, given: dict[str, Any]) -> Settings:
    """What a call was given: settings, parameters or both."""
    if settings is not None and not isinstance(settings, Settings):
        raise Error(f"settings: Settings(...) is wanted, not {type(settings).__name__}")
    return (settings or Settings()).copy(**given)


def _handle(other: Any) -> Any:
    return ffi.gc(must(lib.program_settings_new(other)), lib.program_settings_free)


def _parameters(handle: Any) -> Iterator[Any]:
    parameter, index = ffi.new("struct program_parameter *"), 0
    while lib.program_settings_get_parameter(handle, index, parameter):
        yield parameter
        index += 1


def _text(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return " ".join(str(one) for one in value)
    return str(int(value)) if isinstance(value, bool) else str(value)
