"""Generate the page of all settings, docs/operating/settings.md, from the class `Settings`.

python -m benchmarks.settings_page
"""

import json
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from app.settings import Settings

PAGE = Path(__file__).parents[1] / "docs" / "operating" / "settings.md"
OF_THE_COMMAND = {
    "host": "address to listen on, or `--host`",
    "port": "port to listen on, or `--port`; 0 takes any that is free",
}
HEAD = """# Settings

The settings are environment variables, which the service reads once when it starts. The service ignores names
that are not in this table, so check the spelling first. Lists and objects are written as JSON:
`["/srv/templates"]`. Options of `crankwright serve` take precedence.

`python -m benchmarks.settings_page` generates this page from `app/settings/__init__.py`.

| variable | type | default | meaning |
|---|---|---|---|
"""


def page() -> str:
    """Return the page in Markdown."""
    prefix = Settings.model_config["env_prefix"]
    rows = (_row(f"{prefix}{name}".upper(), name, field) for name, field in Settings.model_fields.items())
    return HEAD + "".join(rows)


def _row(variable: str, name: str, field: FieldInfo) -> str:
    meaning = field.description or OF_THE_COMMAND[name]  # every setting must have a description
    cells = (f"`{variable}`", _type(field), _default(field), meaning)
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |\n"


WORDS = {
    "str": "text",
    "SecretStr": "text",
    "int": "integer",
    "float": "number",
    "bool": "true | false",
    "Path": "path",
}
SIGNS = (("gt", ">"), ("ge", "≥"), ("lt", "<"), ("le", "≤"))


def _type(field: FieldInfo) -> str:
    bounds = [
        f"{sign} {getattr(bound, key):g}"
        for bound in field.metadata
        for key, sign in SIGNS
        if hasattr(bound, key)
    ]
    return ", ".join([f"`{_words(field.annotation)}`", *bounds])


def _words(kind: Any) -> str:
    """Return a type in words for operators."""
    origin, inside = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _words(inside[0])
    if origin is Literal:
        return " | ".join(map(str, inside))
    if origin in (Union, UnionType):
        return " | ".join(_words(part) for part in inside if part is not type(None))
    if origin in (tuple, list):
        return f"list of {_words(inside[0])}"
    if origin is dict:
        return f"object: {_words(inside[1])} for each of {_words(inside[0])}"
    return WORDS[kind.__name__]


def _default(field: FieldInfo) -> str:
    if field.default is PydanticUndefined or field.default is None:
        return "none"
    if isinstance(field.default, tuple | list):
        return f"`{list(map(str, field.default))}`".replace("'", '"')
    if isinstance(field.default, dict):
        return f"`{json.dumps(field.default)}`"
    return f"`{field.default}`"


if __name__ == "__main__":
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page())
    print(f"written: {PAGE.name}")
