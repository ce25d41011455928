"""Start a service with the gallery's examples, and Chromium to open its pages."""

from __future__ import annotations

import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from playwright.sync_api import Browser, sync_playwright

from app.cli.demonstration import service
from app.client import Client

FLAGS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
).split()


@contextmanager
def examples(names: tuple[str, ...]) -> Iterator[tuple[str, list[str], Client]]:
    """Yield the address of a running service, the pages of designs from its gallery, and a client."""
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as client:
        with httpx.Client(base_url=client.url, timeout=60, trust_env=False) as http:
            places = [http.post("/designs", data={"example": name}).headers["location"] for name in names]
            for page in places:
                while client.design(page.rpartition("/")[2]).state == "regenerating":
                    time.sleep(0.2)
            _draw_thumbnails(http)
        yield client.url, places, client


def _draw_thumbnails(http: httpx.Client) -> None:
    """Request every picture of the home page once, so that later visits need not wait for it."""
    for address in re.findall(r'<img src="([^"]+)"', http.get("/").text):
        http.get(address, headers={"Prefer": "wait=60"}).raise_for_status()


@contextmanager
def chromium() -> Iterator[Browser]:
    """Yield Debian's Chromium."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        yield browser
        browser.close()
