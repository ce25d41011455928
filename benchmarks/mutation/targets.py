"""The files that are mutated."""

from benchmarks.mutation import ROOT

TARGETS = (
    *("templates/core/**/*.py", "templates/physics/**/*.py"),
    *("cad/checks.py", "cad/regenerate.py", "cad/inspect.py", "cad/surfaces.py", "app/**/questions.py"),
    *("app/designs/**/*.py", "app/jobs/**/*.py", "app/storage/**/*.py"),
)
"""The files that are mutated: language, physics, checks and keys of solids, designs, jobs, storage."""


def targets() -> list[str]:
    """Return the files that are mutated."""
    files = {file for pattern in TARGETS for file in ROOT.glob(pattern)}
    return sorted(file.relative_to(ROOT).as_posix() for file in files)
