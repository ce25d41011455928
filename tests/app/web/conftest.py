"""One server for all tests of the pages, and Chromium where it is installed."""

from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest
from browsing import AWKWARD, CHROMIUM, FLAGS, THIRD, Watched, created
from patience import patient
from serving import folder_of_models, serving
from sleeping import ALARM, folder_of_sleeper

from app.settings import Settings


@pytest.fixture(scope="session")
def served(tmp_path_factory):
    """The real service, with two templates more in a folder of its own."""
    folder = tmp_path_factory.mktemp("web")
    own = folder_of_models(folder / "templates")
    (own / "own" / "third_v1.py").write_text(THIRD.lstrip())
    (own / "own" / "awkward_v1.py").write_text(AWKWARD.lstrip())
    folder_of_sleeper(own / "sleeper")
    settings = Settings(data=folder / "data", template_folders=(own,), wait_seconds=5)
    with serving(settings) as server:
        yield server


@pytest.fixture
def alarm(served):
    """A file: once a test touches it, whoever sleeps wakes; until the test ends."""
    (own,) = served.settings.template_folders
    file = own / "sleeper" / ALARM
    yield file
    file.unlink(missing_ok=True)


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
        pytest.skip("needs Debian's package chromium-headless-shell or chromium")
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=patient(30_000))
    playwright = BROWSER.enter_context(sync_playwright())
    launched = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
    BROWSER.callback(launched.close)
    return launched


BROWSER = ExitStack()


def pytest_runtest_teardown(item, nextitem):
    """End the browser after the last of these tests.

    Playwright keeps an event loop running in this thread, in which other tests want one of their own.
    """
    if nextitem is None or not nextitem.path.is_relative_to(Path(__file__).parent):
        item.session._setupstate.teardown_exact(nextitem)  # its pages first
        BROWSER.close()


@pytest.fixture
def plotted():
    """Plotly draws the plots of the page `watched`, as it does in every slow test."""


@pytest.fixture(scope="session")
def wide(browser):
    """A wide screen, whose scripts the browser fetches and compiles once."""
    context = browser.new_context(viewport={"width": 1440, "height": 900}, accept_downloads=True)
    context.set_default_timeout(patient(30_000))
    return context


@pytest.fixture
def watched(wide, served, request):
    """A page of a fresh visitor, on a wide screen."""
    is_slow = request.node.get_closest_marker("slow") is not None
    page = wide.new_page()
    forget = wide.new_cdp_session(page).send
    forget("Storage.clearDataForOrigin", {"origin": served.url, "storageTypes": "all"})
    yield Watched(page, served.url, is_slow or "plotted" in request.fixturenames)
    for one in wide.pages:
        one.close()


@pytest.fixture
def plain(browser, served):
    """A page without scripts."""
    context = browser.new_context(java_script_enabled=False)
    context.set_default_timeout(patient(30_000))
    yield Watched(context.new_page(), served.url)
    context.close()


@pytest.fixture
def paper(http):
    """The address of the paper's design, created from the gallery, once its part is built."""
    return created(http, "paper")
