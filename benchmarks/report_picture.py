"""Draws two pages of the calculation report for the docs, and measures how long reports take.

    python -m benchmarks.report_picture

Writes docs/pictures/report_page.png, from the PDF that the service answers; needs poppler's pdftoppm. Prints
the times of HTML and PDF, and how long another request waited meanwhile: typesetting must not hold up the
server.
"""

import io
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from statistics import median

import httpx
from PIL import Image

from app.cli.demonstration import service
from app.designs.bodies import PAPER

TARGET = Path(__file__).parents[1] / "docs" / "pictures" / "report_page.png"
RESOLUTION = 84  # dots per inch
SHOWN = (1, 3)  # pages
TIMES = 7


def main() -> None:
    """Create the paper's design, change its scale, and print its report."""
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as client:
        design = client.create({**PAPER, "parameters": {"scale": "1"}})
        client.change(design, {"parameters": {"scale": "1.25"}})
        address = f"{client.url}/api/v1/designs/{design.id}/report"
        with httpx.Client(timeout=60, trust_env=False) as http:
            pdf = client.report(design.id)
            for kind in ("html", "pdf"):
                print(f"{kind}: {_measured(http, f'{address}.{kind}') * 1e3:.0f} ms")
        print(f"longest wait of GET /healthz while reports are printed: {_waits(address) * 1e3:.0f} ms")
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    _side_by_side([_page(pdf, number) for number in SHOWN]).save(TARGET, optimize=True)


def _measured(http: httpx.Client, address: str) -> float:
    """Return the median time of an answer [s]."""
    times = []
    for _ in range(TIMES):
        start = time.perf_counter()
        http.get(address).raise_for_status()
        times.append(time.perf_counter() - start)
    return median(times)


def _waits(address: str) -> float:
    """Return the longest answer of a trivial request [s] while two clients print reports."""
    done = threading.Event()

    def prints() -> None:
        with httpx.Client(timeout=60, trust_env=False) as http:
            while not done.is_set():
                http.get(f"{address}.pdf").raise_for_status()

    clients = [threading.Thread(target=prints) for _ in range(2)]
    for client in clients:
        client.start()
    with httpx.Client(timeout=60, trust_env=False) as http:
        health = address.partition("/api/")[0] + "/healthz"
        longest = max(_measured_once(http, health) for _ in range(100))
    done.set()
    for client in clients:
        client.join()
    return longest


def _measured_once(http: httpx.Client, address: str) -> float:
    start = time.perf_counter()
    http.get(address).raise_for_status()
    time.sleep(0.02)
    return time.perf_counter() - start - 0.02


def _page(pdf: bytes, number: int) -> Image.Image:
    command = ["pdftoppm", "-r", str(RESOLUTION), "-f", str(number), "-l", str(number), "-png"]
    done = subprocess.run(command, input=pdf, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    return Image.open(io.BytesIO(done.stdout)).convert("RGB")


def _side_by_side(pages: list[Image.Image]) -> Image.Image:
    gap = 12
    width = sum(page.width + gap for page in pages) + gap
    sheet = Image.new("RGB", (width, max(page.height for page in pages) + 2 * gap), (214, 221, 228))
    left = gap
    for page in pages:
        sheet.paste(page, (left, gap))
        left += page.width + gap
    return sheet.quantize(64)


if __name__ == "__main__":
    main()
