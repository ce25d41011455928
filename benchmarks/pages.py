"""Measure the size and response time of the pages, which docs/pages.md quotes.

    python -m benchmarks.pages

Writes benchmarks/results/pages.json. Times are of this machine, in one run: medians in milliseconds.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from statistics import median
from typing import Any

import httpx
from playwright.sync_api import Browser

from benchmarks.browser import chromium, examples

RESULT = Path(__file__).parent / "results" / "pages.json"
TIMES = 20
CHANGES = {
    "closed form (oil_film 1)": {"steps": {"film": {"inputs": {"radial_load": "{} kN"}}}},
    "map (oil_film 2)": {"steps": {"film": {"inputs": {"radial_load": "{} kN"}}}},
    "reynolds (oil_film 2)": {"steps": {"film": {"level": "reynolds", "inputs": {"radial_load": "{} kN"}}}},
}


def main() -> None:
    """Measure and write."""
    with examples(("paper", "shell")) as (url, (paper, shell), _), chromium() as browser:
        sizes = {
            "first visit": {
                "home": _visit(browser, url + "/"),
                "design": _visit(browser, url + paper),
            },
            "preview with worksheet [ms]": _previews(url, (paper, shell, shell)),
            "keystroke to result in the page [ms]": _typing(browser, url + paper),
        }
    RESULT.write_text(json.dumps(sizes, indent=1) + "\n")
    print(RESULT.read_text())


def _visit(browser: Browser, address: str) -> dict[str, Any]:
    """Return the number of requests, compressed bytes, and times of a first visit."""
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    sizes: list[float] = []
    session.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    page.goto(address, wait_until="networkidle")
    timing = page.evaluate("performance.getEntriesByType('navigation')[0].toJSON()")
    page.close()
    return {
        "requests": len(sizes),
        "compressed [kB]": round(sum(sizes) / 1000),
        "interactive [ms]": round(timing["domInteractive"]),
        "loaded [ms]": round(timing["loadEventEnd"]),
    }


def _previews(url: str, pages: tuple[str, ...]) -> dict[str, float]:
    """Return the time of a preview, each with other values."""
    times = {}
    with httpx.Client(base_url=url, timeout=60, trust_env=False) as http:
        for page, (name, patch) in zip(pages, CHANGES.items(), strict=True):
            took = []
            for turn in range(TIMES):
                body = json.loads(json.dumps(patch).replace("{}", f"{20 + turn / 7}"))
                start = time.perf_counter()
                answer = http.post(f"/api/v1{page}/preview", params={"worksheet": True}, json=body)
                took.append(time.perf_counter() - start)
                assert answer.is_success, answer.text
            times[name] = round(1000 * median(took), 1)
    return times


def _typing(browser: Browser, address: str) -> float:
    """Return the time from a key press to the new film thickness, with the pause of the page."""
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.goto(address, wait_until="networkidle")
    load, film = page.get_by_label("Radial load"), page.locator('[data-output="film.minimum_film_thickness"]')
    took = []
    for turn in range(TIMES):
        before = film.text_content()
        start = time.perf_counter()
        load.fill(f"{20 + turn / 7:.4f} kN")
        while film.text_content() == before:
            pass
        took.append(time.perf_counter() - start)
    page.close()
    return round(1000 * median(took))


if __name__ == "__main__":
    main()
