"""Notebooks: `docs/notebooks/*.py`, in cells by `# %%`, are executed and become pages.

The site holds no result that did not come out of the code as it is: a cell that fails ends the build.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jupytext
import nbformat
from nbclient import NotebookClient
from nbconvert import MarkdownExporter
from traitlets.config import Config

from handbook.rendering import ROOT

FOLDER = ROOT / "docs" / "notebooks"
LONGEST = 300  # [s], of one cell


def pages() -> Iterator[tuple[str, str | bytes]]:
    """Each notebook as a page with its pictures, and as a notebook file with its outputs."""
    for path in sorted(FOLDER.glob("*.py")):
        yield from _page(path)


def execute(path: Path) -> Any:
    """A notebook with the outputs of all cells.

    Raises
    ------
    CellExecutionError
        If a cell fails.
    """
    notebook = jupytext.read(path, fmt="py:percent")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "ignore::DeprecationWarning"}
    config = Config(KernelManager={"transport": "ipc"})  # no port is opened
    resources = {"metadata": {"path": str(ROOT)}}
    options: Any = {"timeout": LONGEST, "kernel_name": "python3", "coalesce_streams": True}
    NotebookClient(notebook, config=config, resources=resources, **options).execute(env=environment)
    return notebook


def _page(path: Path) -> Iterator[tuple[str, str | bytes]]:
    notebook = execute(path)
    place = f"notebooks/{path.stem}"
    text, resources = MarkdownExporter().from_notebook_node(
        notebook, {"output_files_dir": f"{path.stem}_files"}
    )
    links = f"\n[The notebook with its results]({path.stem}.ipynb) · [its source]({path.name})\n"
    yield f"{place}.md", text + links
    yield f"{place}.ipynb", nbformat.writes(notebook)
    yield from ((f"notebooks/{name}", content) for name, content in resources["outputs"].items())
