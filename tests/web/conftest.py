"""One server for all tests of the pages, and Chromium where it is installed."""

import shutil
import sys
from pathlib import Path

import httpx
import pytest

sys.path.append(str(Path(__file__).parents[1] / "app"))

from serving import API, serving

from app.settings import Settings

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
).split()

THIRD = '''
"""A third of a length, for tests of the pages."""

from templates.core.template import Array, Template, formula, given


class Third(Template):
    """A third of a length, found nowhere else."""

    example = {"whole_length": "9 mm"}

    l: Array = given("mm", "whole length", gt=0)

    @formula("mm", "third of the length", symbol="t", source="Euclid, book 5")
    def t(self) -> Array:
        return self.l / 3
'''


@pytest.fixture(scope="session")
def served(tmp_path_factory):
    """The real service, with one template more in a folder of its own."""
    folder = tmp_path_factory.mktemp("web")
    own = folder / "templates" / "own"
    own.mkdir(parents=True)
    (own / "third_v1.py").write_text(THIRD.lstrip())
    settings = Settings(data=folder / "data", template_folders=(folder / "templates",), wait_seconds=5)
    with serving(settings) as server:
        yield server


@pytest.fixture
def http(served):
    """Plain HTTP to the service, as a fresh browser that asks for pages."""
    headers = {"Accept": "text/html"}
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False, headers=headers) as http:
        yield http


@pytest.fixture(scope="session")
def browser():
    """Debian's Chromium, driven by Playwright."""
    if CHROMIUM is None:
        pytest.skip("needs Debian's package chromium: apt-get install chromium")
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=20_000)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


class Watched:
    """A page and all that went wrong on it: outside addresses, failures, breaches of the policy."""

    def __init__(self, page, url: str) -> None:
        self.page, self.url = page, url
        self.outside, self.failed, self.told, self.requests = [], [], [], []
        page.route("**/*", self._route)
        page.on("requestfailed", self._on_failure)
        page.on("response", self._on_response)
        page.on("console", self._on_console)
        page.on("pageerror", lambda error: self.told.append(str(error)))

    def _route(self, route) -> None:
        address = route.request.url
        if address.startswith((self.url, "data:", "blob:")):
            self.requests.append(address)
            route.continue_()
        else:
            self.outside.append(address)
            route.abort()

    def _on_failure(self, request) -> None:
        # A preview that a newer one overtakes is cancelled, and so is what a page asks for when it is left.
        if request.failure != "net::ERR_ABORTED":
            self.failed.append((request.url, request.failure))

    def _on_response(self, response) -> None:
        if response.status >= 400:
            self.failed.append((response.url, response.status))

    def _on_console(self, message) -> None:
        if message.type == "error":
            self.told.append(message.text)

    def open(self, path: str, **options):
        """Go to a page of the service."""
        return self.page.goto(self.url + path, **options)

    def faults(self) -> list:
        """Everything that went wrong since the page was made."""
        return [*self.outside, *self.failed, *self.told]


@pytest.fixture
def watched(browser, served):
    """A page of a fresh visitor, on a wide screen."""
    context = browser.new_context(viewport={"width": 1440, "height": 900}, accept_downloads=True)
    yield Watched(context.new_page(), served.url)
    context.close()


@pytest.fixture
def plain(browser, served):
    """A page without scripts."""
    context = browser.new_context(java_script_enabled=False)
    yield Watched(context.new_page(), served.url)
    context.close()


@pytest.fixture
def paper(http):
    """The address of the paper's design, created from the gallery, once its part is built."""
    return created(http, "paper")


def created(http, example: str) -> str:
    """The address of a design from the gallery, once its part is built."""
    answer = http.post("/designs", content=f"example={example}")
    assert answer.status_code == 303, answer.text
    place = answer.headers["location"]
    settled(http, place)
    return place


def settled(http, place: str) -> dict:
    """The design of a page once its regeneration has ended."""
    while (design := http.get(f"{API}{place}").json())["state"] == "regenerating":
        http.get(f"{API}{place}/model.step", headers={"Prefer": "wait=10"})
    return design
