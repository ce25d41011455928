"""Fixtures of a team in addition to tests/components.py: Dask with two workers, and all parts together."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "app"))  # serving, sheets and other helpers
sys.path.append(str(Path(__file__).parents[1] / "app" / "worksheet_import"))  # mathcad_files
