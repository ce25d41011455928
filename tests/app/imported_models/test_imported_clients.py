"""The typed clients and the command line import models."""

import asyncio
import inspect

import pytest
from click.testing import CliRunner

from app.cli.main import main
from app.client import AsyncClient, Client, Problem, model_operations
from cad.regenerate import regenerate


@pytest.fixture(scope="module")
def washer():
    return regenerate("thrust_washer", 1, {"inner_diameter": 0.03}).step


def run(served, *arguments):
    return CliRunner().invoke(main, ["model", *map(str, arguments), "--url", served.url])


def test_the_client_imports_a_step_file_and_gives_it_back(client, washer, tmp_path):
    model = client.import_model("bought_washer", washer, "W 30.stp")
    assert (model.id, model.version, model.title) == ("bought_washer", 1, "Fixed part W 30")
    assert model == client.model_version("bought_washer", 1)
    origin = client.model_origin("bought_washer", 1)
    assert (origin.program, origin.file, origin.parameters) == ("step", "W 30.stp", [])
    original = client.original_model("bought_washer", 1)
    assert (original.name, original.content) == ("W 30.stp", washer)
    assert original.save(tmp_path).read_bytes() == washer


def test_a_file_that_is_there_keeps_its_version_and_the_key_makes_one_of_two(client, washer):
    first = client.import_model("kept_washer", washer, "washer.step", key="one washer")
    again = client.import_model("kept_washer", washer, "washer.step", key="one washer")
    other = client.import_model("kept_washer", washer, "washer.step")
    assert first == again == other


def test_the_awaited_client_follows_the_import(served, washer):
    seen = []

    async def work():
        async with AsyncClient(served.url) as client:
            programs = await client.drawing_programs()
            model = await client.import_model(
                "awaited_washer", washer, "washer.stp", on_progress=lambda part, text: seen.append(text)
            )
            return programs, model

    programs, model = asyncio.run(work())
    assert [one.name for one in programs] == ["FreeCAD", "Creo", "STEP"]
    assert (model.id, model.version) == ("awaited_washer", 1)


def test_what_is_no_model_is_a_problem_of_the_call(client):
    with pytest.raises(Problem, match="begins as no model does") as refused:
        client.import_model("no_model", b"solid stl", "part.stl")
    assert refused.value.status == 422


def test_a_damaged_file_is_a_problem_of_its_job(client):
    with pytest.raises(Problem) as refused:
        client.import_model("damaged_washer", b"ISO-10303-21;\nHEADER;\n", "part.step")
    assert refused.value.status == 422


def test_the_command_imports_shows_and_gives_back(served, washer, tmp_path):
    file = tmp_path / "axial.stp"
    file.write_bytes(washer)
    done = run(served, "import", file, "--id", "axial_washer")
    assert done.exit_code == 0, done.output
    assert "axial_washer version 1: Fixed part axial" in done.output
    assert "trust: lower: the shape is that of the solids in the STEP file" in done.output
    folder = tmp_path / "back"
    folder.mkdir()
    back = run(served, "original", "axial_washer", "--version", 1, "--folder", folder)
    assert back.exit_code == 0, back.output
    assert (folder / "axial.stp").read_bytes() == washer
    assert "STEP (.step, .stp): a fixed part without parameters" in run(served, "programs").output


def test_the_command_says_why_a_file_is_not_taken(served, tmp_path):
    file = tmp_path / "part.stl"
    file.write_bytes(b"solid stl")
    done = run(served, "import", file, "--id", "no_part")
    assert done.exit_code == 1
    assert "send a FreeCAD file (.FCStd), a STEP file" in done.output
    taken = tmp_path / "washer.stp"
    taken.write_bytes(b"ISO-10303-21;")
    assert "ball_bearing" in run(served, "import", taken, "--id", "ball_bearing").output


def test_both_clients_have_every_operation_on_models():
    own = [
        name
        for name, thing in vars(model_operations).items()
        if inspect.isfunction(thing) and thing.__module__ == model_operations.__name__
    ]
    assert len(own) == 5
    for one in (Client, AsyncClient):
        assert all(getattr(one, name).operation is getattr(model_operations, name) for name in own)
