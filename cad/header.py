r"""The header of a STEP file, which identifies the model: its id, version, parameters and build.

The header follows ISO 10303-21: quotes and backslashes are doubled, characters outside ASCII are written as
\X2\…\X0\, and no string of FILE_DESCRIPTION is longer than 256 characters, so each parameter has its own
string, and a long list has several. The time stamp is constant, because the same parameters must give the
same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from cad.part21 import description, plain, quoted

LONGEST_HEADER = 65536
"""Number of bytes that are searched for the header; `write_header` writes a few thousand."""

ONLY_PART = "only part"
"""Name in the header of a file of one part of a model, whose value is the part; no parameter is called so."""

_LONGEST_PART = 180  # longest part of a value in one string, after its name
_NO_TIME = "1970-01-01T00:00:00"
_TITLE = re.compile(r"Crankwright ([a-z][a-z0-9_]{0,63}) version ([1-9][0-9]{0,8})")


@dataclass(frozen=True)
class Header:
    """The header of a STEP file from this program.

    Parameters are text, such as `{"inner_diameter": "50 mm"}`.
    """

    model: str
    version: int
    parameters: Mapping[str, str]
    build: str  # the key, SHA-256 in hexadecimal

    @property
    def title(self) -> str:
        """Return a one-line title for readers."""
        return f"Crankwright {self.model} version {self.version}"


def write_header(header: Header, schema: str, kernel: str) -> str:
    """Return the HEADER section, from `HEADER;` to `ENDSEC;`."""
    described = [header.title, f"build: {header.build}"]
    for name, value in header.parameters.items():
        described.append(f"{name}: {value[:_LONGEST_PART]}")
        if len(value) > _LONGEST_PART:
            described += _continued(name, value)
    lines = ",\n  ".join(map(quoted, described))
    name = quoted(f"{header.model}_v{header.version}.step")
    return (
        f"HEADER;\nFILE_DESCRIPTION((\n  {lines}),'2;1');\n"
        f"FILE_NAME({name},'{_NO_TIME}',(''),(''),{quoted(kernel)},'Crankwright','');\n"
        f"FILE_SCHEMA(({quoted(schema)}));\nENDSEC;"
    )


def read_header(step: bytes) -> Header | None:
    """Return the header of a STEP file; None if the file does not come from this program."""
    strings = [plain(string) for string in description(step[:LONGEST_HEADER].decode("latin-1"))]
    title = _TITLE.fullmatch(strings[0]) if strings else None
    pairs = _joined(strings[1:])
    if title is None or "build" not in pairs:
        return None
    build = pairs.pop("build")
    return Header(title[1], int(title[2]), pairs, build)


def _continued(name: str, value: str) -> list[str]:
    """Return the additional strings of a long value; each begins with the parameter name and a plus sign."""
    places = range(_LONGEST_PART, len(value), _LONGEST_PART)
    return [f"{name}+: {value[at : at + _LONGEST_PART]}" for at in places]


def _joined(strings: list[str]) -> dict[str, str]:
    """Return the parameters; a value in several strings is joined."""
    parts: dict[str, list[str]] = {}
    for string in strings:
        name, _, value = string.partition(": ")
        if name.endswith("+") and name[:-1] in parts:
            parts[name[:-1]].append(value)
        else:
            parts[name] = [value]
    return {name: "".join(values) for name, values in parts.items()}
