"""The job behind a proxy, in a network of its own: a browser signs in, works, and signs out.

It prints one JSON object of what it saw. `one_network.py` runs it; VARIANT is `keys` or `login`.
"""

import json
import os
import re
import subprocess
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlencode, urlsplit

import httpx

CHROMIUM, FOLDER, VARIANT = os.environ["CHROMIUM"], Path(os.environ["FOLDER"]), os.environ["VARIANT"]
NAME, ISSUER = "bearings.example.com", "http://127.0.0.1:9000"
URL = f"https://{NAME}"
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--ignore-certificate-errors",
    f"--host-resolver-rules=MAP {NAME} 127.0.0.1",
]
LOGIN = ("engineer", "crankshaft")
DESIGN = {"name": "through the proxy", "parameters": {"gap": "50 um"}}


class Provider(BaseHTTPRequestHandler):
    """An OpenID provider that signs everybody in as Ada, and checks the address of her return."""

    asked: dict[str, str] = {}

    def log_message(self, *_):
        pass

    def do_GET(self):
        where = urlsplit(self.path)
        if where.path == "/auth":
            Provider.asked = {name: values[0] for name, values in parse_qs(where.query).items()}
            self.send_response(303)
            back = urlencode({"state": self.asked["state"], "code": "c"})
            self.send_header("Location", f"{self.asked['redirect_uri']}?{back}")
            self.end_headers()
        elif where.path == "/keys":
            self.say({"keys": [KEY.as_dict(private=False)]})
        else:
            ends = {"authorization_endpoint": "auth", "token_endpoint": "token", "jwks_uri": "keys"}
            self.say({"issuer": ISSUER, **{name: f"{ISSUER}/{end}" for name, end in ends.items()}})

    def do_POST(self):
        sent = parse_qs(self.rfile.read(int(self.headers["Content-Length"])).decode())
        assert sent["redirect_uri"] == [self.asked["redirect_uri"]]
        claims = {
            "iss": ISSUER,
            "aud": "crank",
            "sub": "ada-1",
            "name": "Ada by proxy",
            "exp": int(time.time()) + 60,
        }
        self.say(
            {
                "id_token": jwt.encode(
                    {"alg": "RS256", "kid": "1"}, claims | {"nonce": self.asked["nonce"]}, KEY
                )
            }
        )

    def say(self, answer):
        body = json.dumps(answer).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


def program(*arguments):
    return [sys.executable, "-m", "app", *arguments]


def key_of(role):
    """A key of a new principal, by the command of the documentation."""
    said = subprocess.run(
        program("keys", "add", role, "--role", role, "--data", str(FOLDER / "data")),
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return re.search(r"cw_[a-z0-9]{10}_[A-Za-z0-9_-]{43}", said.stdout + said.stderr)[0]


def serve(settings):
    log = (FOLDER / "service.log").open("w")
    names = {"CRANKWRIGHT_ALLOWED_HOSTS": json.dumps([NAME]), **settings}
    started = subprocess.Popen(
        program("serve", "--port", "8000", "--data", str(FOLDER / "data")),
        env={**os.environ, **names}, stdout=log, stderr=log,
    )  # fmt: skip
    for _ in range(600):
        try:
            if httpx.get("http://127.0.0.1:8000/healthz", trust_env=False).status_code == 200:
                return started
        except httpx.HTTPError:
            time.sleep(0.1)
    raise AssertionError("the service did not start")


def answers(headers, auth=None):
    """Return the states of reading and of creating a design through the proxy."""
    own = {"headers": {"Host": NAME, **headers}, "auth": auth, "timeout": 60}
    with httpx.Client(base_url="https://127.0.0.1", verify=False, trust_env=False, **own) as http:
        extensions = {"sni_hostname": NAME}
        read = http.get("/api/v1/designs", extensions=extensions)
        made = http.post("/api/v1/designs", json=DESIGN, extensions=extensions)
        return [read.status_code, made.status_code]


def cookies_of(context):
    return {
        one["name"]: one["secure"] for one in context.cookies() if one["name"].startswith("crankwright_sign")
    }


def by_key(browser, key, headers):
    """Sign in by key, create a design by the page's own origin, and sign out."""
    context = browser.new_context(ignore_https_errors=True, extra_http_headers=headers)
    page = context.new_page()
    page.goto(f"{URL}/designs")
    page.get_by_label("Key").fill(key)
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_url(f"{URL}/designs")
    seen = {"secure": cookies_of(context), "signed_in": page.get_by_role("link", name="author").count() > 0}
    page.goto(f"{URL}/account")
    page.get_by_role("button", name="Sign out").click()
    page.wait_for_url("**/sign-in*")
    seen["signed_out"] = not cookies_of(context)
    context.close()
    return seen


def by_provider(browser):
    """Sign in with the provider, to the end: the account page names the person."""
    context = browser.new_context(ignore_https_errors=True)
    page = context.new_page()
    page.goto(f"{URL}/account")
    page.get_by_role("link", name="Sign in with your organisation").click()
    page.wait_for_url(f"{URL}/account")
    seen = {"secure": cookies_of(context), "named": "Ada by proxy" in page.content()}
    context.close()
    return {**seen, "redirect_uri": Provider.asked["redirect_uri"]}


def keys(browser):
    author = key_of("author")
    threading.Thread(
        target=ThreadingHTTPServer(("127.0.0.1", 9000), Provider).serve_forever, daemon=True
    ).start()
    service = serve({"CRANKWRIGHT_OIDC_ISSUER": ISSUER, "CRANKWRIGHT_OIDC_CLIENT": "crank"})
    try:
        return {
            "browser": by_key(browser, author, {}),
            "browser_with_basic": by_key(browser, author, {"Authorization": "Basic ZW5naW5lZXI6eA=="}),
            "provider": by_provider(browser),
            "bearer": answers({"Authorization": f"Bearer {author}"}),
            "nobody": answers({}),
            "basic": answers({}, LOGIN),
        }
    finally:
        service.terminate()
        service.wait(30)


def login(browser):
    service = serve({})
    try:
        context = browser.new_context(
            ignore_https_errors=True, http_credentials={"username": LOGIN[0], "password": LOGIN[1]}
        )
        page = context.new_page()
        page.goto(f"{URL}/designs")
        return {
            "title": page.title(),
            "basic": answers({}, LOGIN),
            "nobody": answers({}),
            "wrong": answers({}, (LOGIN[0], "x")),
        }
    finally:
        service.terminate()
        service.wait(30)


if __name__ == "__main__":
    from joserfc import jwt
    from joserfc.jwk import RSAKey
    from playwright.sync_api import sync_playwright

    KEY = RSAKey.generate_key(2048, {"kid": "1"})
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        sys.stdout.write(json.dumps({"keys": keys, "login": login}[VARIANT](launched)))
        launched.close()
