"""Print the slow test files related to the files that changed, one a line; standard library only.

A slow test is related to every file that it imports, directly or not, and to the data files that these name.
Tests of a whole server import everything, so a table says which files they are about. The base of comparison
is `CRANKWRIGHT_CI_BASE`, or else the commit before; if there is none, a fixed selection is printed.
"""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
HTTP = ("app/*routes*.py", "app/*schemas*.py", "app/api/*.py", "app/http/*.py")
WEB = ("app/*web/*.py", "app/*presentation/*.py", "app/web/*.js", "app/web/*.css", "app/web/*.html")
ABOUT = {
    "tests/app/imported_models/test_freecad.py": (
        *("app/imported_models/*.py", "cad/imported_models.py", "cad/freecad/*.py"),
        *("app/imported_models/routes.py", "app/*workers/*.py"),
    ),
    "tests/app/imported_models/test_assemblies.py": (
        "app/imported_models/*.py",
        "cad/imported_models.py",
        "cad/assembl*.py",
    ),
    "tests/app/imported_models/test_assembly_page.py": ("app/imported_models/*.py", *WEB),
    "tests/app/calculations/processes/test_calculations_in_processes.py": (
        "app/*calculations/*.py",
        "app/pool/*.py",
        "app/*workers/*.py",
    ),
    "tests/app/solids/test_analysis_bore.py": ("app/solids/*.py", "cad/analysis/*.py"),
    "tests/app/test_bidi.py": WEB,
    "tests/app/designs/test_design_files.py": ("app/solids/*.py", "app/designs/routes/files.py"),
    "tests/app/designs/test_design_revisions.py": ("app/designs/*.py", "app/solids/*.py"),
    "tests/app/solids/test_elastic_bore.py": ("app/solids/*.py", "app/designs/*.py", "cad/analysis/*.py"),
    "tests/app/http/test_guard.py": ("app/http/*.py", "app/settings/hosts.py"),
    "tests/app/settings/test_hosts.py": (
        "app/settings/hosts.py",
        "app/http/*.py",
        "app/settings/__init__.py",
    ),
    "tests/app/test_linear_input_http.py": (
        "app/http/strict_requests.py",
        "app/http/problems.py",
        "app/designs/*.py",
    ),
    "tests/app/solids/test_models_api.py": ("app/solids/*.py", "app/solids/routes/models.py"),
    "tests/app/worksheets/test_sheet_check.py": ("app/worksheets/*.py", "templates/core/sheets/*.py"),
    "tests/app/identity/test_sign_in_oidc.py": ("app/identity/*.py",),
    "tests/app/solids/test_solid_fields.py": ("app/solids/*.py", "app/designs/routes/solid_fields.py"),
    "tests/app/studies/test_study_cancels.py": ("app/studies/*.py", "app/*jobs/*.py"),
    "tests/app/studies/test_study_cancels_builds.py": ("app/studies/*.py", "app/*jobs/*.py"),
    "tests/app/designs/test_variants_http.py": ("app/designs/*.py", "app/solids/*.py"),
    "tests/app/solids/test_analysis_lists.py": (
        *("app/solids/*.py", "app/designs/*.py", "cad/analysis/*.py", "cad/cranks/*.py"),
        "app/solids/routes/analyses.py",
    ),
    "tests/app/solids/test_analysis_tables.py": ("app/solids/*.py", "app/designs/*.py", "cad/analysis/*.py"),
    "tests/app/solids/test_analyses.py": (
        "app/solids/*.py",
        "app/solids/routes/analyses.py",
        "cad/analysis/*.py",
    ),
    "tests/app/test_analyses_designs.py": ("app/solids/*.py", "app/designs/*.py", "cad/analysis/*.py"),
    "tests/app/client/test_client.py": ("app/*client/*.py", "app/reports/*.py", "app/*schemas*.py"),
    "tests/app/designs/test_conditional_designs_http.py": ("app/designs/*.py", "app/reports/*.py"),
    "tests/app/test_crank_gallery.py": (
        *("app/solids/*.py", "app/studies/*.py", "app/designs/gallery/*.py", "cad/analysis/*.py"),
        *("templates/stiffness/*.py", "templates/physics/fatigue/*.py", "cad/models/crank_throw_v1.py"),
    ),
    "tests/app/test_crash.py": (
        *("app/*jobs/*.py", "app/*storage/*.py", "app/*designs/*.py", "app/*workers/*.py"),
        "app/*idempotency*.py",
    ),
    "tests/app/http/test_attack.py": ("app/http/*.py", "app/identity/*.py", "app/*routes*.py"),
    "tests/app/maintenance/test_backup.py": ("app/*maintenance/*.py", "app/*storage/*.py"),
    "tests/app/test_damage.py": ("app/solids/*.py", "app/*storage/*.py"),
    "tests/app/studies/test_damper_study.py": (
        *("app/studies/*.py", "templates/stiffness/forced_torsion_v1.py", "templates/physics/torsion/*.py"),
    ),
    "tests/app/cli/test_demo.py": (
        "app/cli/demo*.py",
        "app/cli/main.py",
        "app/cli/serve.py",
        "app/__main__.py",
        "app/http/server.py",
    ),
    "tests/app/designs/test_designs_http.py": ("app/*jobs/*.py", "app/*workers/*.py"),
    "tests/app/cli/test_embedded_start.py": ("app/*.py", "pyproject.toml"),
    "tests/app/test_engine_gallery.py": (
        *("app/designs/gallery/*.py", "app/designs/*.py", "templates/bearing_load/*.py"),
        *("templates/physics/engine/*.py", "cad/cranks/*.py", "cad/models/crankshaft_v1.py"),
    ),
    "tests/app/jobs/test_events_resumed.py": ("app/*event*.py", "app/api/event_streams.py"),
    "tests/app/http/test_evaluate_hostile.py": (
        *("app/calculations/routes/evaluate.py", "app/http/strict_requests.py", "app/http/problems.py"),
    ),
    "tests/app/designs/test_linear_input.py": (
        "app/reports/*.py",
        "app/http/problems.py",
        "app/designs/*.py",
    ),
    "tests/app/designs/test_list_parameters.py": ("app/designs/*.py", "app/web/*.py", "cad/lists.py"),
    "tests/app/test_orphans.py": ("app/*workers/*.py",),
    "tests/app/solids/test_other_makers.py": ("app/solids/*.py", "app/*storage/*.py"),
    "tests/app/http/test_problems_hostile.py": HTTP,
    "tests/app/observation/test_readiness.py": ("app/observation/readiness.py", "app/*workers/*.py"),
    "tests/app/reports/test_report_verdict.py": ("app/reports/*.py", "app/presentation/*.py"),
    "tests/app/test_report.py": ("app/reports/*.py", "app/presentation/*.py"),
    "tests/app/reports/test_signed_reports.py": (
        "app/reports/*.py",
        "app/approvals/*.py",
        "app/cli/approvals.py",
    ),
    "tests/app/http/test_slow_clients.py": ("app/http/server.py", "app/http/*.py"),
    "tests/app/designs/test_solve_design.py": ("app/designs/*.py", "templates/core/language/*.py"),
    "tests/app/studies/test_studies.py": ("app/studies/*.py", "app/*schemas*.py"),
    "tests/app/studies/test_study_heals.py": ("app/studies/*.py", "app/*maintenance/*.py"),
    "tests/app/studies/test_study_kills.py": ("app/studies/*.py", "app/*jobs/*.py", "app/*workers/*.py"),
    "tests/app/studies/test_study_parts.py": ("app/studies/*.py",),
    "tests/app/studies/test_study_solids.py": ("app/studies/*.py", "app/solids/*.py"),
    "tests/app/tolerances/test_tolerances.py": ("app/tolerances/*.py", "app/reports/*.py"),
    "tests/app/tolerances/test_tolerance_analysis.py": ("app/tolerances/*.py",),
    "tests/app/jobs/test_turns.py": ("app/*jobs/*.py",),
    "tests/app/designs/test_variants_jobs.py": ("app/designs/*.py", "app/*jobs/*.py", "app/solids/*.py"),
    "tests/app/jobs/dispatcher/test_jobs_interrupted.py": ("app/*jobs/*.py", "app/*workers/*.py"),
    "tests/app/calculations/processes/test_calculations_as_jobs.py": (
        "app/*jobs/*.py",
        "app/*workers/*.py",
        "app/calculations/*.py",
        "app/pool/*.py",
    ),
    "tests/app/designs/test_saves_as_jobs.py": (
        "app/*jobs/*.py",
        "app/designs/*.py",
        "app/calculations/*.py",
        "app/pool/*.py",
    ),
    "tests/app/worksheets/test_sheet_start.py": ("app/worksheets/*.py", "app/*storage/*.py"),
    "tests/app/studies/test_study_resumes.py": ("app/studies/*.py",),
    "tests/app/catalogue/test_team_templates.py": ("app/catalogue/*.py", "templates/core/checks/*.py"),
    "tests/app/http/test_stopping.py": ("app/http/server.py", "app/*jobs/*.py", "app/*workers/*.py"),
    "tests/app/web/test_foreign_pages.py": ("app/http/*.py",),
    "tests/app/http/test_contract_all_at_length.py": HTTP,
    "tests/app/http/test_contract_at_length.py": HTTP,
    "tests/app/http/test_interface_at_length.py": HTTP,
    "tests/app/test_openapi_fuzz.py": HTTP,
}
"""Patterns of the files that a test of a whole server is about; `*` stands for folders too. For one of the
pages that is not named they are `WEB`."""
ALWAYS = ("tests/physics/test_mobility_map.py", "tests/cad/analysis/test_torsion_reference.py")
"""What runs if nobody can say what changed: one file for each kind of solver."""
CATALOGUE = "tests/templates/test_catalogue_properties.py"
VERSION = re.compile(r"^(?:templates|cad)/\w+/(\w+)_v\d+\.py$")  # found by name, not by an import
SLOW = re.compile(r"\bmark\.(?:slow|sampled)\b")  # a test with cases in the slow lane
EVERYWHERE = ("constraints.txt", "pyproject.toml", "tests/conftest.py", "tests/*/conftest.py")
"""Files that all tests depend on."""


def changed(base: str) -> list[str] | None:
    """Return the files that differ from the base, uncommitted ones too; None if Git cannot say."""
    try:
        start = git("merge-base", base, "HEAD").strip()
        return (
            git("diff", "--name-only", start).split()
            + git("ls-files", "--others", "--exclude-standard").split()
        )
    except (subprocess.CalledProcessError, FileNotFoundError):  # a shallow clone, a first commit, no Git
        return None


def git(*arguments: str) -> str:
    """Return what Git prints."""
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout


def slow_files() -> list[str]:
    """Return the test files that hold slow tests, but for those of a team, which have a lane of their own."""
    files = (file for file in (ROOT / "tests").rglob("test_*.py") if file.parent.name != "team")
    return sorted(name(file) for file in files if SLOW.search(file.read_text(encoding="utf-8")))


def name(file: Path) -> str:
    """Return the name of a file in the repository."""
    return file.relative_to(ROOT).as_posix()


@cache
def reach(file: str) -> frozenset[str]:
    """Return the file and all of ours that it imports, directly or not."""
    reached, ahead = {file}, [file]
    while ahead:
        new = set(imports(ahead.pop())) - reached
        reached |= new
        ahead += new
    return frozenset(reached)


@cache
def imports(file: str) -> tuple[str, ...]:
    """Return our files that a file imports, wherever in it."""
    tree = ast.parse(text(file))
    return tuple(found for module in modules(tree) for found in located(module, Path(file).parent))


@cache
def text(file: str) -> str:
    """Return what one of our files contains."""
    return (ROOT / file).read_text(encoding="utf-8")


def modules(tree: ast.AST) -> Iterator[str]:
    """Yield the modules that a file imports, and what may be modules."""
    for node in statements(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def statements(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield a tree and the statements in it, but not their expressions, which are ten times as many."""
    ahead = [tree]
    while ahead:
        node = ahead.pop()
        yield node
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            inner = getattr(node, part, None)
            ahead += inner if isinstance(inner, list) else ()


def located(module: str, folder: Path) -> Iterator[str]:
    """Yield the files of a module: of a package of ours, or of a helper beside the test."""
    path = module.replace(".", "/")
    for place in (Path(), folder, Path("tests"), Path("tests/app")):
        for file in (f"{path}.py", f"{path}/__init__.py"):
            if is_there(there := f"{place.as_posix()}/{file}".removeprefix("./")):
                yield there


@cache
def is_there(file: str) -> bool:
    """Whether we have this file."""
    return (ROOT / file).is_file()


def about(test: str) -> tuple[str, ...]:
    """Return the patterns of the files that a test of a whole server is about; none for another test."""
    return ABOUT.get(test, WEB if test.startswith("tests/app/web/") else ())


def is_related(test: str, files: Iterable[str]) -> bool:
    """Whether a slow test file should run after changes of these files."""
    if patterns := about(test):
        helpers = {file for file in reach(test) if file.startswith("tests/")}
        return any(file in helpers or fnmatch(file, pattern) for file in files for pattern in patterns)
    reached = reach(test)
    return any(file in reached or is_named(file, test, reached) for file in files)


def is_named(file: str, test: str, reached: Iterable[str]) -> bool:
    """Whether one of these programs names a data file, or the test finds this version in the catalogue."""
    if version := VERSION.search(file):
        is_listed = test == CATALOGUE and file.startswith("templates/")
        own = (test, *(program for program in reached if program.startswith("tests/")))
        return is_listed or any(version[1] in text(one) for one in own)
    if file.endswith((".py", ".md")):
        return False
    return any(Path(file).name in text(program) for program in reached)


def selection(files: list[str] | None) -> list[str]:
    """Return the slow test files to run after changes of these files."""
    if files is None:
        return sorted(ALWAYS)
    related = [test for test in slow_files() if is_related(test, files)]
    is_everywhere = any(fnmatch(file, pattern) for file in files for pattern in EVERYWHERE)
    return sorted({*related, *(ALWAYS if is_everywhere else ())})


def main() -> None:
    """Print the selection."""
    base = os.environ.get("CRANKWRIGHT_CI_BASE") or "HEAD~1"
    files = changed(base)
    if files is None:
        sys.stderr.write(f"Git cannot compare with {base}: a fixed selection of slow tests\n")
    sys.stdout.writelines(f"{test}\n" for test in selection(files))


if __name__ == "__main__":
    main()
