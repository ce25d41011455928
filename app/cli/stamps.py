"""`crankwright verify` and `crankwright stamp-keys …`: stamps of STEP and GLB files, and their keys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import click

from app.settings import Settings
from app.signing.keys import PublicKey, StampKeys, UnusableKey, folder_of, public_keys_in
from app.signing.verification import EXIT_CODES, Verdict, verify
from cad.signed_file import Claims
from templates.core.errors import plain

_LONGEST_FILE = 2**20  # of public keys [bytes]
_MOST_SHOWN = 300  # characters of a line about a claim
_data = click.option(
    "--data", type=click.Path(path_type=Path), default=None, help="data folder; default: CRANKWRIGHT_DATA"
)


@click.command("verify")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--key",
    "keys",
    required=True,
    multiple=True,
    metavar="PUBLIC",
    help="public key that you trust, `ed25519:…`, or a file with such keys (repeatable)",
)
@click.pass_context
def verify_command(ctx: click.Context, file: Path, keys: tuple[str, ...]) -> None:
    """Verify the signed stamp of FILE (STEP or GLB); no service is needed.

    The exit code is 0 only if a given key signed exactly these bytes. 1: the file was changed, 3: its stamp
    names another key, 4: it has no signed stamp, 5: another program wrote it from a file of Crankwright,
    6: it is neither STEP nor GLB, or cannot be read.
    """
    try:
        verdict = verify(file, _public_keys(keys))
    except OSError as error:
        verdict = Verdict("unreadable", f"the file cannot be read: {error.strerror}")
    is_valid = verdict.kind == "valid"
    words = verdict.kind.replace("_", " ")
    click.secho(plain(f"{words}: {verdict.words}", _MOST_SHOWN), fg=None if is_valid else "red")
    if is_valid and verdict.claims is not None:
        for line in _described(verdict.claims):
            click.echo(plain(line, _MOST_SHOWN))
    ctx.exit(EXIT_CODES[verdict.kind])


def _public_keys(given: Sequence[str]) -> list[PublicKey]:
    keys = [key for text in given for key in _keys_in(text)]
    return list({key.public: key for key in keys}.values())


def _keys_in(text: str) -> list[PublicKey]:
    """Return the public keys in a text, or in the file that it names."""
    if keys := public_keys_in(text):
        return keys
    try:
        with Path(text).open("rb") as file:
            keys = public_keys_in(file.read(_LONGEST_FILE).decode("utf-8", "replace"))
    except OSError as error:
        detail = f"{text[:100]!r} is neither a key, `ed25519:` and 64 digits, nor a readable file"
        raise click.BadParameter(f"{detail} ({error.strerror})", param_hint="--key") from None
    if not keys:
        raise click.BadParameter(f"{text[:100]!r} holds no key `ed25519:…`", param_hint="--key")
    return keys


def _described(claims: Claims) -> Iterator[str]:
    """Yield the claims of a valid stamp, a line each."""
    design = claims["design"]
    yield f"design {design['name']} ({design['id']}), revision {claims['revision']} of {claims['date']} UTC"
    named = [f"{name} {claims[name]}" for name in ("variant", "model", "part") if name in claims]
    yield f"{', '.join(named)}, file {claims['kind']}"
    yield f"build {claims['build']['key']}, stored file {claims['build']['sha256']}"
    yield "parameter of a face: relation that sets it"
    for parameter, relation in claims["relations"].items():
        yield f"  {parameter}: {relation}"


@click.group("stamp-keys")
def stamp_keys_command() -> None:
    """List the public keys that verify stamps, and replace the private key."""


@stamp_keys_command.command("list")
@_data
def list_command(data: Path | None) -> None:
    """Print the public keys, the one in use first; `verify --key` takes a file with this output."""
    with _opened(data) as keys:
        if not keys.exist():
            raise click.ClickException(f"{keys.folder} has no key yet; a service creates it when it starts")
        for key in keys.public():
            _show(key)


@stamp_keys_command.command("rotate")
@_data
def rotate_command(data: Path | None) -> None:
    """Replace the private key, and print the new public key; files signed before remain valid.

    A running service signs with the new key at once. Give the new public key to those who verify files.
    """
    with _opened(data) as keys:
        keys.rotate()
        _show(keys.public()[0])


def _show(key: PublicKey) -> None:
    since = f"since {key.since[:16]}Z" if key.since else "since unknown"
    click.echo(f"{key.public}  {key.id}  {since}" + (f" until {key.until[:16]}Z" if key.until else ""))


@contextmanager
def _opened(data: Path | None) -> Iterator[StampKeys]:
    settings = Settings() if data is None else Settings(data=data)
    if (folder := folder_of(settings)) is None:
        raise click.ClickException("servers of a team share their keys: set CRANKWRIGHT_STAMP_KEYS")
    if not folder.parent.is_dir():
        raise click.ClickException(f"there is no folder {folder.parent.absolute()}; name the data folder")
    try:
        yield StampKeys(folder)
    except UnusableKey as error:
        raise click.ClickException(str(error)) from None
    except OSError as error:
        raise click.ClickException(f"{folder.absolute()} cannot hold the keys: {error.strerror}") from None
