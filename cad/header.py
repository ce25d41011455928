r"""The header of a STEP file, in which a model says what it is: its id, version, parameters and build.

Written and read as ISO 10303-21 says: a quote is doubled, a backslash too, what is not ASCII is written as
\X2\…\X0\, and no string of FILE_DESCRIPTION is longer than 256 characters, so each parameter has one of
its own. The time is a fixed one: the same parameters must give the same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

_NO_TIME = "1970-01-01T00:00:00"
_STRING = r"'((?:[^']|'')*)'"
_TITLE = re.compile(r"Crankwright ([a-z][a-z0-9_]*) version ([1-9][0-9]*)")
_WIDE = re.compile(r"\\X2\\((?:[0-9A-F]{4})*)\\X0\\")


@dataclass(frozen=True)
class Header:
    """What a STEP file of ours says of itself; parameters as text, such as `{"inner_diameter": "50 mm"}`."""

    model: str
    version: int
    parameters: Mapping[str, str]
    build: str  # the key, SHA-256 in hexadecimal

    @property
    def title(self) -> str:
        """One line for people."""
        return f"Crankwright {self.model} version {self.version}"


def write_header(header: Header, schema: str, kernel: str) -> str:
    """The HEADER section, from `HEADER;` to `ENDSEC;`."""
    described = [header.title, f"build: {header.build}"]
    described += [f"{name}: {value}" for name, value in header.parameters.items()]
    lines = ",\n  ".join(map(_quoted, described))
    name = _quoted(f"{header.model}_v{header.version}.step")
    return (
        f"HEADER;\nFILE_DESCRIPTION((\n  {lines}),'2;1');\n"
        f"FILE_NAME({name},'{_NO_TIME}',(''),(''),{_quoted(kernel)},'Crankwright','');\n"
        f"FILE_SCHEMA(({_quoted(schema)}));\nENDSEC;"
    )


def read_header(step: bytes) -> Header | None:
    """What a STEP file says of itself, or None if it is not one of ours."""
    text = step[:65536].decode("latin-1").split("ENDSEC;")[0]
    described = re.search(rf"FILE_DESCRIPTION\s*\(\s*\(((?:\s*{_STRING}\s*,?)*)\)", text)
    strings = [_plain(s) for s in re.findall(_STRING, described[1])] if described else []
    title = _TITLE.fullmatch(strings[0]) if strings else None
    pairs = dict(s.partition(": ")[::2] for s in strings[1:])
    if title is None or "build" not in pairs:
        return None
    build = pairs.pop("build")
    return Header(title[1], int(title[2]), pairs, build)


def _quoted(text: str) -> str:
    """A Part 21 string."""
    doubled = text.replace("\\", "\\\\").replace("'", "''")
    return (
        "'"
        + re.sub(r"[^ -~]+", lambda m: f"\\X2\\{m[0].encode('utf-16-be').hex().upper()}\\X0\\", doubled)
        + "'"
    )


def _plain(text: str) -> str:
    """What a Part 21 string says; line breaks within are layout."""
    joined = text.replace("\n", "").replace("\r", "").replace("''", "'")
    wide = _WIDE.sub(lambda m: bytes.fromhex(m[1]).decode("utf-16-be", "replace"), joined)
    return wide.replace("\\\\", "\\")
