"""`crankwright worksheet …`: exchange worksheets as text files with the service, and change their states.

A file is named `<id>.sheet`, or `<id>_v<n>.sheet` if it is one version of several. It contains the exact text
of the worksheet.
"""

from __future__ import annotations

import re
from pathlib import Path

import click

from app.cli.connections import connected, data_option, url_option
from app.client import Client
from app.worksheets.schemas.imports import ImportedRegion
from app.worksheets.schemas.worksheets import Sheet, SheetCheck, SheetSummary
from templates.core.errors import plain

OPEN = ("draft", "tested", "reviewed")
"""States in which an edit does not start a new version."""
FILE = re.compile(r"([a-z][a-z0-9_]*?)(?:_v([1-9][0-9]*))?\.sheet")
_files = click.argument(
    "files", nargs=-1, required=True, type=click.Path(exists=True, dir_okay=False, path_type=Path)
)


@click.group("worksheet")
def worksheet_command() -> None:
    """Manage templates that are written as text: check, import, test, review, release, withdraw, export."""


@worksheet_command.command("list")
@url_option
@data_option
def list_command(url: str | None, data: Path | None) -> None:
    """List every worksheet at its newest version."""
    with connected(url, data) as client:
        for one in client.worksheets():
            review = f", reviewed by {one.reviewer}{_doubt(one, ', ')}" if one.reviewer else ""
            click.echo(f"{one.id} {one.version}  ({one.state}{review})  {plain(one.title)}")


@worksheet_command.command("check")
@_files
@url_option
@data_option
@click.pass_context
def check_command(ctx: click.Context, files: tuple[Path, ...], url: str | None, data: Path | None) -> None:
    """Check FILES and run their tests without saving anything. The exit code is 1 if there is a fault."""
    with connected(url, data) as client:
        checks = {file: client.check_worksheet(_text(file)) for file in files}
    for file, check in checks.items():
        _print(file, check)
    ctx.exit(0 if all(map(_is_sound, checks.values())) else 1)


@worksheet_command.command("import-text")
@_files
@click.option("--author", help="author of the worksheets")
@url_option
@data_option
def import_command(files: tuple[Path, ...], author: str | None, url: str | None, data: Path | None) -> None:
    """Save FILES as drafts: `<id>.sheet` creates a worksheet, or edits the existing one.

    Import the versions of one worksheet in order; all but the last must already be released.
    """
    named = sorted((_named(file), file) for file in files)
    with connected(url, data) as client:
        ids = {one.id for one in client.worksheets()}
        for (id, number), file in named:
            sheet = client.read_worksheet(id) if id in ids else None
            _require_next(file, number, sheet)
            sheet = _saved(client, id, _text(file), author, sheet)
            ids.add(id)
            faults = f", {len(sheet.faults)} faults" if sheet.faults else ""
            click.echo(f"{sheet.id} version {sheet.version}: {sheet.state}{faults}")


@worksheet_command.command("import")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--id", help="id of the worksheet; default: the name of the file")
@url_option
@data_option
@click.pass_context
def import_sheet_command(
    ctx: click.Context, file: Path, id: str | None, url: str | None, data: Path | None
) -> None:
    """Import FILE, a sheet of Mathcad Prime (.mcdx) or Mathcad 11 to 15 (.xmcd, .xmcdz), as a draft.

    The command prints the outcome for each region. The exit code is 1 if some regions prevent a release.
    """
    with connected(url, data) as client:
        sheet = client.import_worksheet(id or _id_of(file), file.read_bytes(), file.name)
        report = client.read_import(sheet.id)
    counts = ", ".join(f"{count} {state}" for state, count in report.regions if count)
    click.echo(f"{sheet.id} version {sheet.version}: {sheet.state}; mathematical regions: {counts or 'none'}")
    for region in report.items:
        if region.is_unresolved:
            line = f"line {region.line}: " if region.line else ""
            click.echo(
                plain(f"  {line}region {region.region} {region.state}: {region.reason or _values(region)}")
            )
    ctx.exit(1 if report.unresolved else 0)


def _values(region: ImportedRegion) -> str:
    """Return both values of a region whose results differ."""
    return f"Mathcad {region.mathcad[:5]}, worksheet {region.worksheet[:5]} {region.unit or ''}"


def _id_of(file: Path) -> str:
    """Return the worksheet id that a file's name states."""
    words = re.sub(r"[^a-z0-9]+", "_", file.stem.lower()).strip("_") or "sheet"
    return (words if words[0].isalpha() else f"sheet_{words}")[:64]


@worksheet_command.command("export")
@click.argument("place")
@click.option("--version", type=int, default=None, help="version to export; default: the newest")
@url_option
@data_option
def export_command(place: str, version: int | None, url: str | None, data: Path | None) -> None:
    """Print the text of the worksheet PLACE, an id, or export all worksheets into the folder PLACE.

    The export into a folder has every version of every worksheet.
    """
    with connected(url, data) as client:
        if Path(place).is_dir():
            for one in client.worksheets():
                _export(client, client.read_worksheet(one.id), Path(place))
        else:
            click.echo(client.worksheet_text(place, version).encode(), nl=False)


@worksheet_command.command("test")
@click.argument("id")
@url_option
@data_option
def test_command(id: str, url: str | None, data: Path | None) -> None:
    """Run the tests of the draft ID, and calculate its example and steps around it."""
    with connected(url, data) as client:
        sheet = client.test_worksheet(client.read_worksheet(id))
    for test in sheet.tests:
        click.echo(f"line {test.line}: {test.words}: {test.message}")
    _say(sheet)


@worksheet_command.command("review")
@click.argument("id")
@click.option("--reviewer", required=True, help="your name, which must differ from the author's")
@click.option("--digest", required=True, help="digest of the text that you reviewed, or its first 12 digits")
@url_option
@data_option
def review_command(id: str, reviewer: str, digest: str, url: str | None, data: Path | None) -> None:
    """Record that you have reviewed the text of ID with this digest, which `test` prints."""
    with connected(url, data) as client:
        sheet = client.read_worksheet(id)
        if len(digest) < 12 or not (sheet.digest or "").startswith(digest):
            raise click.ClickException(
                f"{id} has digest {sheet.digest}, not {digest}: read its current text first"
            )
        _say(client.review_worksheet(sheet, reviewer))


@worksheet_command.command("release")
@click.argument("id")
@url_option
@data_option
def release_command(id: str, url: str | None, data: Path | None) -> None:
    """Release the reviewed worksheet ID as a template, which never changes."""
    with connected(url, data) as client:
        _say(client.release_worksheet(client.read_worksheet(id)))


@worksheet_command.command("withdraw")
@click.argument("id")
@click.option("--reason", required=True, help="why it must no longer be used")
@click.option(
    "--version", type=int, default=None, help="version to withdraw; default: the newest released one"
)
@url_option
@data_option
def withdraw_command(id: str, reason: str, version: int | None, url: str | None, data: Path | None) -> None:
    """Withdraw a released version of ID, and state the reason."""
    with connected(url, data) as client:
        _say(client.withdraw_worksheet(id, reason, version))


def _saved(client: Client, id: str, text: str, author: str | None, sheet: Sheet | None) -> Sheet:
    if sheet is None:
        return client.create_worksheet(id, text, author=author)
    return sheet if sheet.text == text else client.change_worksheet(sheet, text, author=author)


def _require_next(file: Path, number: int, sheet: Sheet | None) -> None:
    """Refuse a file whose version is not the one that an edit would create; version 0 means any.

    Raises
    ------
    ClickException
        If the versions differ.
    """
    is_open = sheet is not None and sheet.state in OPEN
    possible = 1 if sheet is None else sheet.version if is_open else sheet.version + 1
    is_there = sheet is not None and number == sheet.version and sheet.text == _text(file)
    if number not in (0, possible) and not is_there:
        raise click.ClickException(
            f"{file.name} would become version {possible}, not {number}: release the versions before it first"
        )


def _export(client: Client, sheet: Sheet, folder: Path) -> None:
    """Write every version of a worksheet into a folder, one file each."""
    for version in sheet.versions:
        name = f"{sheet.id}_v{version.version}.sheet" if len(sheet.versions) > 1 else f"{sheet.id}.sheet"
        (folder / name).write_bytes(client.worksheet_text(sheet.id, version.version).encode())
        click.echo(name)


def _say(sheet: Sheet) -> None:
    review = f", reviewed by {sheet.reviewer}{_doubt(sheet, '; ')}" if sheet.reviewer else ""
    click.echo(f"{sheet.id} version {sheet.version}: {sheet.state}{review}; digest {sheet.digest}")


def _doubt(sheet: Sheet | SheetSummary, sign: str) -> str:
    """Return a remark if the reviewer's name was not verified."""
    return "" if sheet.review_verified else f"{sign}review not verified"


def _is_sound(check: SheetCheck) -> bool:
    return not check.faults and all(test.passed for test in check.tests)


def _print(file: Path, check: SheetCheck) -> None:
    for fault in check.faults:
        remedy = f"\n    {fault.remedy}" if fault.remedy else ""
        click.echo(f"{file}:{fault.line}:{fault.column}: {fault.message}{remedy}")
    for test in check.tests:
        click.echo(f"{file}:{test.line}: test {'passed' if test.passed else 'FAILED'}: {test.message}")
    if not check.faults:
        click.echo(f"{file}: {check.title}, digest {check.digest}")


def _named(file: Path) -> tuple[str, int]:
    """Return the id and the version in a file name; version 0 if the name has none."""
    if (match := FILE.fullmatch(file.name)) is None:
        raise click.ClickException(
            f"{file.name} is not named <id>.sheet or <id>_v<n>.sheet, such as bush_duty.sheet"
        )
    return match[1], int(match[2] or 0)


def _text(file: Path) -> str:
    """Return the text of a file with its original line endings."""
    try:
        return file.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise click.ClickException(f"{file} is not a text file in UTF-8") from None
