"""What MkDocs calls while it builds the site: adds the generated pages, then refuses outside addresses."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

from handbook import client, criteria, decisions, language, map_of_code, models, notebooks, rest, templates

Content = str | bytes

SOURCES = {
    "templates": templates.pages,
    "models": models.pages,
    "criteria": criteria.pages,
    "language": language.pages,
    "rest": rest.pages,
    "client": client.pages,
    "map": map_of_code.pages,
    "decisions": decisions.pages,
    "notebooks": notebooks.pages,
}
"""What writes pages, path → text or bytes. `generated: NAME` in the navigation lists those of one."""

_generated: dict[str, dict[str, Content]] = {}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Write the generated pages, and put them into the navigation where `generated: NAME` stands."""
    _generated.clear()
    for name, write in SOURCES.items():
        _generated[name] = dict(write())
    config.nav = list(_filled(config.nav or []))
    return config


def _filled(entries: list[Any]) -> Iterator[Any]:
    for entry in entries:
        if isinstance(entry, dict) and "generated" in entry:
            yield from (path for path in _generated[entry["generated"]] if path.endswith(".md"))
        elif isinstance(entry, dict) and "decisions" in entry:
            yield from (f"decisions/{path.name}" for path in decisions.files())
        elif isinstance(entry, dict):
            yield {t: list(_filled(v)) if isinstance(v, list) else v for t, v in entry.items()}
        else:
            yield entry


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages to those in `docs/`."""
    for pages in _generated.values():
        for path, content in pages.items():
            files.append(File.generated(config, path, content=content))
    return files


_LOADED = re.compile(
    r"<(?:script|img|iframe|link|source)\b[^>]*?\b(?:src|href)=[\"']?((?:https?:)?//[^\"'\s>]+)"
)


def on_post_page(output: str, page: Any, **_: Any) -> str:
    """Refuse a page that would load anything from elsewhere: the site works offline.

    Raises
    ------
    PluginError
        Naming the page and the address.
    """
    for address in _LOADED.findall(output):
        raise PluginError(f"{page.file.src_uri} loads {address}; keep a copy in docs/ instead")
    return output


def on_post_build(config: MkDocsConfig) -> None:
    """Refuse style sheets that load anything from elsewhere.

    Raises
    ------
    PluginError
        Naming the file.
    """
    for sheet in Path(config.site_dir).rglob("*.css"):
        if re.search(r"(?:@import|url\()\s*[\"']?(?:https?:)?//", sheet.read_text(encoding="utf-8")):
            raise PluginError(f"{sheet.name} loads something from outside")
