"""Query parameters of pages."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query

Id = Annotated[str, Path(max_length=64, pattern=r"^[A-Za-z0-9_]+$")]
Number = Annotated[int, Path(ge=1, le=10**9)]
Text = Annotated[str, Query(max_length=200)]
