"""The examples of a team's deployment: systemd accepts the units, and all settings exist."""

import shutil
import subprocess
from pathlib import Path

import pytest

from app.cli.main import COMMANDS
from app.settings import Settings

DEPLOY = Path(__file__).parents[2] / "docs" / "deploy"
UNITS = sorted(DEPLOY.glob("*.service"))


@pytest.fixture(scope="module")
def services():
    yaml = pytest.importorskip("yaml", reason="PyYAML comes with the extra team")
    return yaml.safe_load((DEPLOY / "compose.yaml").read_text())["services"]


def test_every_part_is_there_and_starts_again(services):
    assert set(services) == {"database", "files", "scheduler", "worker", "one", "two", "proxy"}
    assert {service["restart"] for service in services.values()} == {"always"}


def test_services_wait_for_services_that_there_are(services):
    for service in services.values():
        assert set(service.get("depends_on", ())) <= set(services)


def test_variables_are_settings_and_commands_are_commands(services):
    known = {f"CRANKWRIGHT_{name.upper()}" for name in Settings.model_fields}
    ours = [service for service in services.values() if service["image"] == "crankwright:local"]
    assert len(ours) == 4
    for service in ours:
        names = {name for name in service["environment"] if name.startswith("CRANKWRIGHT_")}
        assert names <= known
        assert service["command"][0] == "crankwright"
        assert service["command"][1] in COMMANDS


def test_only_the_proxy_is_reached_from_outside(services):
    assert [name for name, service in services.items() if "ports" in service] == ["proxy"]


@pytest.mark.skipif(not shutil.which("systemd-analyze"), reason="systemd is not installed")
@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.stem)
def test_a_unit_is_one(unit, tmp_path):
    copy = tmp_path / unit.name
    text = unit.read_text()
    assert "Restart=always" in text
    copy.write_text(text.replace("/opt/crankwright/bin/crankwright", shutil.which("true")))
    command = ["systemd-analyze", "verify", "--man=no", str(copy)]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (checked.returncode, checked.stderr) == (0, "")
