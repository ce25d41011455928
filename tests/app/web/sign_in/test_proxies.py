"""A browser and a program work through nginx and Caddy with the unchanged files of the documentation."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import httpx
import pytest
from browsing import CHROMIUM
from patience import patient
from serving import serving

from app.settings import Settings

ROOT = Path(__file__).parents[4]
FILES = {
    (proxy, variant): ROOT / "docs" / "operating" / f"{file}-{variant}{end}"
    for proxy, file, end in (("nginx", "nginx", ".conf"), ("caddy", "Caddyfile", ""))
    for variant in ("keys", "login")
}
PAGE = {"Accept": "text/html"}
SECURE = {"crankwright_sign_in": True}


def own_network():
    """Whether this user may have a network of its own."""
    may = ["unshare", "--net", "--mount", "true"]
    return (
        bool(shutil.which("unshare"))
        and subprocess.run(may, capture_output=True, check=False).returncode == 0
    )


@pytest.fixture
def seen(request, tmp_path):
    """What the job saw behind a proxy."""
    proxy, variant = request.param
    needed = {proxy: shutil.which(proxy), "chromium": CHROMIUM, "the right to unshare": own_network()}
    if missing := [name for name, is_there in needed.items() if not is_there]:
        pytest.skip(f"needs {', '.join(missing)}")
    pytest.importorskip("joserfc", reason="needs the extra team")
    here = Path(__file__).parent
    command = ["unshare", "--net", "--mount", sys.executable, str(here / "one_network.py"), proxy]
    command += [str(FILES[proxy, variant]), str(tmp_path), str(here / "behind_proxy.py")]
    known = {"CHROMIUM": CHROMIUM, "FOLDER": str(tmp_path), "VARIANT": variant, "PYTHONPATH": str(ROOT)}
    run = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **known},
        timeout=patient(300),
    )
    logs = "".join(file.read_text()[-2000:] for file in tmp_path.glob("*.log"))
    assert run.returncode == 0, f"{run.stderr[-3000:]}\n{logs}"
    return json.loads(run.stdout.splitlines()[-1])


@pytest.mark.slow
@pytest.mark.parametrize("seen", [("nginx", "keys"), ("caddy", "keys")], indirect=True)
def test_keys_and_a_provider_work_through_the_proxy(seen):
    done = {"secure": SECURE, "signed_in": True, "signed_out": True}
    assert seen["browser"] == seen["browser_with_basic"] == done
    back = "https://bearings.example.com/sign-in/oidc/back"
    assert seen["provider"] == {"secure": SECURE, "named": True, "redirect_uri": back}
    assert seen["bearer"] == [200, 201]
    assert seen["nobody"] == seen["basic"] == [401, 401]


@pytest.mark.slow
@pytest.mark.parametrize("seen", [("nginx", "login"), ("caddy", "login")], indirect=True)
def test_name_and_password_of_the_proxy_admit_to_a_service_without_keys(seen):
    assert "Crankwright" in seen["title"]
    assert seen["basic"] == [200, 201]
    assert seen["nobody"] == seen["wrong"] == [401, 401]


@pytest.mark.parametrize(("trusted", "is_secure"), [(["127.0.0.0/8"], True), (["10.0.0.7", "::/8"], False)])
def test_only_trusted_proxies_say_that_the_page_came_by_https(tmp_path, trusted, is_secure):
    with serving(Settings(data=tmp_path, trusted_proxies=trusted)) as server:
        identity = server.app.state.services.identity
        key = identity.add_key(identity.add("Ada", ["author"]).id)[0].text
        headers = {**PAGE, "X-Forwarded-Proto": "https"}
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False, headers=headers) as http:
            cookie = http.post("/sign-in", data={"key": key}).headers["set-cookie"]
    assert ("Secure" in cookie) is is_secure


@pytest.mark.parametrize("entry", ["proxy", "10.0.0.7/24", "*", "", "10.0.0"])
def test_a_network_that_is_none_is_refused_with_an_example(entry):
    with pytest.raises(ValueError, match=r"is no network: write an address such as 10\.0\.0\.7"):
        Settings(trusted_proxies=(entry,))


@pytest.mark.parametrize("other", ["Basic ZW5naW5lZXI6eA==", "Digest x", "Negotiate abc"])
def test_only_bearer_is_a_key(team, other):
    with team.http(headers=PAGE) as http:
        http.post("/sign-in", data={"key": team.keys["viewer"]})
        assert http.get("/account", headers={"Authorization": other}).status_code == 200
        assert http.get("/account", headers={"Authorization": "Bearer cw_nothing"}).status_code != 200
