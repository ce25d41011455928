"""A client that openapi-python-client generates from openapi.json carries out the paper's demonstration."""

import importlib
import json
import subprocess
import sys

import pytest
from patience import patient, until
from serving import paper

pytest.importorskip("openapi_python_client", reason="openapi-python-client is not installed")

PACKAGE = "generated_crankwright"
GENERATION = patient(120.0)  # s
CONFIG = {
    "package_name_override": PACKAGE,
    "post_hooks": [],  # the code need not be formatted
    "content_type_overrides": {"model/step": "application/octet-stream"},
}
"""The generator does not know STEP files, which are bytes."""


@pytest.fixture(scope="module")
def generated(http, tmp_path_factory):
    """The output of the generator, whose package can be imported."""
    folder = tmp_path_factory.mktemp("generated")
    (folder / "openapi.json").write_bytes(http.get("/openapi.json").content)
    (folder / "config.json").write_text(json.dumps(CONFIG))
    command = [sys.executable, "-m", "openapi_python_client", "generate", "--meta", "none"]
    places = ["--path", "openapi.json", "--config", "config.json", "--output-path", PACKAGE]
    run = subprocess.run(
        [*command, *places], cwd=folder, capture_output=True, text=True, timeout=GENERATION, check=False
    )
    printed = run.stdout + run.stderr
    assert run.returncode == 0, printed
    sys.path.insert(0, str(folder))
    yield printed
    sys.path.remove(str(folder))
    for name in [name for name in sys.modules if name.partition(".")[0] == PACKAGE]:
        del sys.modules[name]


def part(name):
    return importlib.import_module(f"{PACKAGE}.{name}")


@pytest.fixture
def service(generated, served):
    client = part("client").Client(base_url=served.url, httpx_args={"trust_env": False}, timeout=90)
    with client as client:
        yield client


def test_the_generator_understands_every_schema(generated):
    assert "Unable to" not in generated
    missing = [line for line in generated.splitlines() if "will not be generated" in line]
    assert len(missing) == 1, generated
    assert "POST /api/v1/curves" in missing[0]  # the generator cannot send text/csv


def shown(service, id):
    """The design once nothing of it is being regenerated."""
    show = part("api.designs.show_design").sync
    return until(lambda: show(id, client=service), lambda design: design.state != "regenerating")


def bore(service, design):
    """The bore of the bearing, as measured on its STEP file."""
    measured = part("api.designs.show_measurements").sync(design.id, client=service)
    return measured["model"].dimensions["inner_diameter"]


def test_scale_changes_the_bearing(service):
    models = part("models")
    document = models.DesignIn.from_dict(paper(name="by a generated client"))
    created = part("api.designs.create_design").sync(client=service, body=document)
    design = shown(service, created.id)
    assert (design.state, design.revision) == ("current", 1)
    assert design.parameters["scale"] == "1"
    first = bore(service, design)
    assert (first.value, first.unit) == (pytest.approx(48, rel=1e-9), "mm")

    parameters = models.DesignPatchParametersType0.from_dict({"scale": "1.02"})
    change = part("api.designs.change_design").sync_detailed
    patch = models.DesignPatch(parameters=parameters, note="SCALE")
    answer = change(design.id, client=service, body=patch, if_match=f'"{design.revision}"')
    assert answer.status_code in (200, 202)
    changed = shown(service, design.id)
    assert (changed.state, changed.revision) == ("current", 2)
    second = bore(service, changed)
    assert (second.value, second.unit) == (pytest.approx(48.96, rel=1e-9), "mm")

    revision = part("api.designs.show_revision").sync(design.id, 2, client=service)
    assert revision.note == "SCALE"
    used = revision.steps["film"].inputs["bearing_diameter"]
    assert (used.value, used.unit, used.from_) == (pytest.approx(48.96), "mm", "given")
    assert revision.steps["film"].outputs["minimum_film_thickness"].value > 0

    late = change(design.id, client=service, body=patch, if_match='"1"')
    assert (late.status_code, late.parsed.status) == (412, 412)
    assert late.parsed.title


def test_a_wrong_input_is_named(service):
    models = part("models")
    body = models.EvaluateIn.from_dict({"inputs": {"radial_load": "-1 N"}})
    refused = part("api.templates.evaluate_template").sync("oil_film", 1, client=service, body=body)
    assert isinstance(refused, models.Problem)
    assert "radial_load" in {fault.name for fault in refused.errors}
