"""Mutation tests: small changes of the code, each of which some related test must notice.

Cosmic Ray makes the changes. `places` lists and samples them, `related` says which test files are about a
file, `trial` applies one mutant to a copy of the repository and runs these tests, `verdict` sums up and
compares the survivors with the reasons in `.ci/mutants.toml`.
"""

from pathlib import Path

ROOT = Path(__file__).parents[2]
