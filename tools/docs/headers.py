# SPDX-License-Identifier: MIT
"""The public headers as pages: their comments as text, their declarations as objects of Sphinx's C
domain, and every name of rhotrack in either as a link.

A header is read as it is laid out: a comment belongs to the declarations below it up to a blank
line, or to the one before it on its line; `---- x ----` begins a part; indented text is set as
typed.
"""
import re

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
DIRECTIVE = re.compile(r"#(?:[^\n]*\\\n)*[^\n]*")
NAME = re.compile(r"\b(?:rho|RHO)_\w+\b|(?<![\w/.])(?:rhotrack/)?(?:detail/)?\w+\.h\b")
TAG = re.compile(r"(struct|enum|union)\s+(\w+)\s*\{(.*)\}", re.DOTALL)
FIELD_LISTS = ("Errors:", "Cost:", "Stack:", "Returns ", "Constant cost")


def prose(comment):
    """The lines of a comment without its marks."""
    lines = [re.sub(r"^\s*\* ?", "", line) if i else line.strip()
             for i, line in enumerate(comment[2:-2].split("\n"))]
    return "\n".join(line.rstrip() for line in lines).strip("\n")


def pieces(text, end=";"):
    """(kind, text, is after a blank line) of comments, #defines and declarations in their order;
    end is the mark behind a declaration."""
    at = 0
    while at < len(text):
        space = re.match(r"\s*", text[at:])[0]
        start = at = at + len(space)
        is_apart = space.count("\n") > 1
        if at == len(text):
            return
        if match := COMMENT.match(text, at):
            at = match.end()
            is_behind = "\n" not in space and start > len(space)  # on the line of a declaration
            yield "behind" if is_behind else "comment", prose(match[0]), is_apart
        elif match := DIRECTIVE.match(text, at):
            at = match.end()
            if match[0].count("/*") > match[0].count("*/"):  # its comment goes on below
                at = text.index("*/", start) + 2
            if match[0].startswith("#define"):
                code = COMMENT.sub("", text[start:at])
                yield "macro", re.sub(r"\s*\\\n\s*", " ", code), is_apart
            for one in COMMENT.findall(text[start:at]):
                yield "behind", prose(one), False
        else:
            at = end_of_declaration(text, at, end)
            yield "declaration", text[start:at], is_apart


def end_of_declaration(text, at, mark):
    """Behind the mark, or the brace of a function's body; the last enumerator has no mark."""
    depth = 0
    while at < len(text):
        if text.startswith("/*", at):
            if depth == 0 and mark == ",":
                break
            at = text.index("*/", at) + 2
            continue
        depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(text[at], 0)
        at += 1
        if depth == 0 and (text[at - 1] == mark or text[at - 1:at + 1] == "}\n"):
            break
    return at


def groups(found):
    """[comment, [[kind, text, comment behind], ...]] of what belongs together."""
    made = [["", []]]
    for kind, text, is_apart in found:
        if kind == "behind" and made[-1][1]:
            made[-1][1][-1][2] += ("\n\n" if made[-1][1][-1][2] else "") + text
        elif kind in ("comment", "behind"):
            made.append([text, []])
        else:
            if is_apart and (made[-1][1] or made[-1][0]):
                made.append(["", []])
            made[-1][1].append([kind, text, ""])
    return [group for group in made if group[0] or group[1]]


class Reference:
    """All headers, so that names are known before the first page is written."""

    def __init__(self, headers):
        """headers: path below include/ by text."""
        self.headers, self.roles = headers, {}
        for text in headers.values():
            plain = COMMENT.sub("", text)
            for name in re.findall(r"#define (\w+)", plain):
                self.roles[name] = "c:macro"
            for kind, name, body in re.findall(r"\b(struct|enum|union) (\w+)\s*\{(.*?)\}", plain,
                                               re.DOTALL):
                self.roles[name] = f"c:{kind}"
                if kind == "enum":
                    self.roles.update(dict.fromkeys(re.findall(r"\b(RHO_\w+)", body),
                                                    "c:enumerator"))
            for name in re.findall(r"\b(rho_\w+)\(", plain):
                self.roles.setdefault(name, "c:func")

    def _link(self, match):
        name = match[0]
        if name.endswith(".h"):
            path = next((one for one in self.headers if f"/{one}".endswith(f"/{name}")), None)
            return f"\\ :doc:`{name} </include/{path}>`\\ " if path else self._escape(name)
        role = self.roles.get(name)
        return f"\\ :{role}:`{name}`\\ " if role else self._escape(name)

    @staticmethod
    def _escape(text):
        return re.sub(r"([*`|_\\])", r"\\\1", text)

    def text(self, comment):
        """Comment as reStructuredText: paragraphs, indented parts as typed."""
        lines, is_typed = [], False
        for line in comment.split("\n"):
            is_indented = line.startswith("  ")
            if is_indented and not is_typed:
                lines += ["", "::", ""]
            elif is_typed and line and not is_indented:
                lines.append("")
            if line.startswith(FIELD_LISTS):
                lines.append("")
            is_typed = is_indented or (is_typed and not line)
            if is_typed:
                lines.append("   " + line)
                continue
            at, made = 0, ""
            for match in NAME.finditer(line):
                made += self._escape(line[at:match.start()]) + self._link(match)
                at = match.end()
            lines.append(made + self._escape(line[at:]))
        return "\n".join(lines)

    def page(self, path):
        """reStructuredText of a header."""
        text = self.headers[path]
        text = re.sub(r"#ifdef __cplusplus.*?#endif|^RHO_(BEGIN|END)_C$", "", text,
                      flags=re.DOTALL | re.MULTILINE)
        guard = re.search(r"#ifndef (RHOTRACK_\w+)\n#define \1\n", text)
        head, text = text[:guard.start()], text[guard.end():]
        about = prose(COMMENT.findall(head)[-1])
        out = [path, "=" * len(path), "", self.text(about), "",
               f".. code-block:: c\n\n   #include \"{path}\"", ""]
        seen = set()
        for comment, entries in groups(pieces(text)):
            if part := re.fullmatch(r"-+ (.*?) -+", comment):
                out += [part[1], "-" * len(part[1]), ""]
                comment = ""
            is_one = len(entries) == 1
            if comment and not is_one:
                out += [self.text(comment), ""]
            for kind, code, behind in entries:
                behind = "\n\n".join(one for one in (comment if is_one else "", behind) if one)
                out += self.entry(kind, code.strip(), behind, seen)
        return "\n".join(out) + "\n"

    def entry(self, kind, code, comment, seen):
        if kind == "macro":
            return self.macro(code, comment, seen)
        if tag := TAG.match(code):
            return self.tagged(*tag.groups(), comment)
        signature = re.sub(r"\s+", " ", COMMENT.sub("", code.split("{")[0])).strip(" ;")
        signature = re.sub(r"\b(RHO_MUST_CHECK|static inline) ", "", signature)
        if "(" not in signature:
            return []
        name = re.search(r"(\w+)\(", signature)[1]
        if self.roles[name] != "c:func":  # Sphinx's C has one room for functions and structs
            return ["", ".. code-block:: c", "", f"   {signature};", "", self.text(comment), ""]
        return directive("function", [signature], self.text(comment))

    def macro(self, code, comment, seen):
        name, value = re.match(r"#define (\w+(?:\([^)]*\))?)\s*(.*)", code, re.DOTALL).groups()
        if name in seen:
            return []
        seen.add(name)
        value = f"``{value.strip()}``" if value.strip() else ""
        return directive("macro", [name], f"{value} {self.text(comment)}".strip())

    def tagged(self, kind, name, body, comment):
        out = directive(kind, [name], self.text(comment))
        for above, entries in groups(pieces(body, "," if kind == "enum" else ";")):
            if not entries or above.startswith("--") or above.endswith(":"):
                out += indented([self.text(above.strip("- ")), ""])
                above = ""
            for _, code, behind in entries:
                told, above = "\n\n".join(one for one in (above, behind) if one), ""
                out += indented(self.member(kind, code.strip(" ,;\n"), told))
        return out

    def member(self, kind, code, comment):
        if kind == "enum":
            return directive("enumerator", [COMMENT.sub("", code).split("=")[0].strip()],
                             self.text(comment))
        if "{" in code or "?" in code:  # more than Sphinx's C can say
            return ["", ".. code-block:: c", "", *indented(code.split("\n")), ""] + (
                [self.text(comment), ""] if comment else [])
        code = re.sub(r"\s+", " ", COMMENT.sub("", code))
        first, *others = re.split(r",\s*(?![^\[(]*[\])])", code)
        base = re.match(r"((?:const |struct |enum |union |unsigned )*\w+)", first)[1]
        return directive("member", [first, *(f"{base} {one}" for one in others)],
                         self.text(comment))


def indented(lines):
    return [f"   {line}" if line else "" for one in lines for line in one.split("\n")]


def directive(kind, signatures, text):
    first, *others = signatures
    return ["", f".. c:{kind}:: {first}", *(" " * (8 + len(kind)) + one for one in others),
            "", *indented(text.split("\n")), ""]
