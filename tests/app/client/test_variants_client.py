"""The typed clients and `crankwright download` fetch variants: the table, one file, all files."""

import asyncio
import io
import zipfile

import pytest
from click.testing import CliRunner
from serving import moody

from app.cli.main import main
from app.client import AsyncClient, Problem

TABLE = {"a": {"model.size": "17 mm"}, "b": {"model.size": {"value": 18, "unit": "mm"}}}


@pytest.fixture(scope="module")
def design(client):
    return client.create(moody("16 mm"))


def test_a_table_is_written_read_and_downloaded(client, design):
    saved = client.put_variants(design, TABLE, "two sizes")
    assert [(row.name, row.state) for row in saved.rows] == [("a", "current"), ("b", "current")]
    assert saved.rows[1].values["model.size"].value == 18
    assert client.put_variants(saved, saved.variants).revision == saved.revision
    assert client.variants(design.id).rows == saved.rows
    assert client.variants(design.id, 1).rows == []
    assert client.design(design.id).variants == TABLE
    with pytest.raises(Problem) as stale:
        client.put_variants(design, {})
    assert stale.value.status == 412
    step = client.download_variant(design.id, "a")
    assert step.name == "block_a_r2.step"
    (use,) = [use for use in client.verify(step.content).revisions if use.design == design.id]
    assert (use.variant, use.revision, use.current) == ("a", 2, True)
    archive = client.download_variants(design.id)
    assert archive.name == "block_variants_r2.zip"
    names = zipfile.ZipFile(io.BytesIO(archive.content)).namelist()
    assert names == ["block_a_r2.step", "block_b_r2.step"]


def test_the_other_client_has_the_same_calls(served, client):
    design = client.create(moody("16 mm", variants=TABLE))

    async def ask():
        async with AsyncClient(served.url) as other:
            saved = await other.put_variants(design, {"a": {}})
            return saved, await other.variants(design.id), await other.download_variant(design.id, "a")

    saved, read, step = asyncio.run(ask())
    assert saved == read
    assert step.name == "block_a_r2.step"


def test_outputs_are_asked_for_by_name(client, design):
    with pytest.raises(Problem) as refused:
        client.variants(client.create(moody(variants=TABLE)).id, outputs=["film.power_loss"])
    assert [fault.name for fault in refused.value.errors] == ["outputs.film.power_loss"]


@pytest.mark.parametrize(
    ("arguments", "name"),
    [(["step", "--variant", "b"], "bar_b_r1.step"), (["zip"], "bar_variants_r1.zip")],
)
def test_the_command_saves_files_of_variants(served, client, tmp_path, arguments, name):
    design = client.create({**moody("16 mm", variants=TABLE), "name": "bar"})
    command = ["download", design.id, *arguments, "--folder", str(tmp_path), "--url", served.url]
    result = CliRunner().invoke(main, command)
    assert result.exit_code == 0, result.output
    assert [path.name for path in tmp_path.iterdir()] == [name]
