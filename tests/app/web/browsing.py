"""Shared helpers for tests of pages: a watched page, designs of the gallery, a test template."""

import shutil

from patience import until
from serving import API

BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser")
CHROMIUM = next(filter(None, map(shutil.which, BROWSERS)), None)
"""Chromium without a window takes half the processor time of the one that draws a window nobody sees."""
FLAGS = [
    *"--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking".split(),
    *"--disable-component-update --disable-sync".split(),
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1, EXCLUDE localhost",
]
"""No name leads outside: an address that a page asks there is noted, and does not answer."""

THIRD = '''
"""A third of a length, for tests of the pages."""

from templates.core.language.template import Array, Template, formula, given


class Third(Template):
    """A third of a length, found nowhere else."""

    example = {"whole_length": "9 mm"}

    l: Array = given("mm", "whole length", gt=0)

    @formula("mm", "third of the length", symbol="t", source="Euclid, book 5")
    def t(self) -> Array:
        return self.l / 3
'''

AWKWARD = '''
"""A template whose inputs are called like parts of a form of HTML, for tests of the pages."""

from templates.core.language.template import Array, Template, formula, given


class Awkward(Template):
    """A sum of lengths with awkward names."""

    example = {"length": "1 mm", "dataset": "2 mm", "level": "3 mm", "elements": "4 mm"}

    a: Array = given("mm", "length", gt=0)
    b: Array = given("mm", "dataset", gt=0)
    c: Array = given("mm", "level", gt=0)
    d: Array = given("mm", "elements", gt=0)

    @formula("mm", "awkward sum", symbol="s", source="Euclid, book 2")
    def s(self) -> Array:
        return self.a + self.b + self.c + self.d
'''


STAND_IN = """{
  const stand_in = {
    async react(place, traces, layout) {
      place.classList.add("js-plotly-plot");
      place.style.height = `${layout.height}px`;
      place.data = traces;
      place.on = (event, act) => { (place.acts ??= {})[event] = act; };
    },
    async addTraces(place, trace) { place.data.push(trace); },
    async restyle(place, { vertexcolor }, numbers) {
      numbers.forEach((number, n) => { place.data[number].vertexcolor = vertexcolor[n]; });
    },
    async deleteTraces(place, number) { place.data.splice(number, 1); },
  };
  const { get, set } = Object.getOwnPropertyDescriptor(HTMLScriptElement.prototype, "src");
  Object.defineProperty(HTMLScriptElement.prototype, "src", { get, set(address) {
    if (!address.endsWith("/static/plotly.min.js")) return set.call(this, address);
    window.Plotly = stand_in;
    setTimeout(() => this.dispatchEvent(new Event("load")));
  } });
}"""
"""In the place of Plotly, whose script and pictures take more than half the processor time of a page.

It takes that place in the page. A route of Playwright would do so too, but then every request goes through
this process, and the browser caches none.
"""


class Watched:
    """A page and all that went wrong on it: outside addresses, failures, breaches of the policy.

    Unless it is `plotted`, its plots keep their data and their size, and nothing is drawn.
    """

    def __init__(self, page, url: str, plotted: bool = False) -> None:
        self.page, self.url, self.plotted = page, url, plotted
        self.outside, self.failed, self.messages, self.requests = [], [], [], []
        if not plotted:
            page.add_init_script(STAND_IN)
        page.on("request", self._on_request)
        page.on("requestfailed", self._on_failure)
        page.on("response", self._on_response)
        page.on("console", self._on_console)
        page.on("pageerror", lambda error: self.messages.append(str(error)))

    def _on_request(self, request) -> None:
        is_ours = request.url.startswith((self.url, "data:", "blob:"))
        (self.requests if is_ours else self.outside).append(request.url)

    def _on_failure(self, request) -> None:
        # A preview that a newer one overtakes is cancelled, and so is what a page asks for when it is left.
        if request.failure != "net::ERR_ABORTED":
            self.failed.append((request.url, request.failure))

    def _on_response(self, response) -> None:
        if response.status >= 400:
            self.failed.append((response.url, response.status))

    def _on_console(self, message) -> None:
        if message.type == "error":
            self.messages.append(message.text)

    def open(self, path: str, **options):
        """Go to a page of the service."""
        return self.page.goto(self.url + path, **options)

    def faults(self) -> list:
        """Everything that went wrong since the page was made."""
        return [*self.outside, *self.failed, *self.messages]


def created(http, example: str) -> str:
    """The address of a design from the gallery, once its part is built."""
    answer = http.post("/designs", data={"example": example})
    assert answer.status_code == 303, answer.text
    place = answer.headers["location"]
    settled(http, place)
    return place


def from_example(http, template: str) -> str:
    """The address of a design of one step with the example of a template, `oil_film/2`."""
    id, _, version = template.partition("/")
    example = http.get(f"{API}/templates/{id}/versions/{version}").json()["example"]
    step = {"template": id, "version": int(version), "inputs": example}
    response = http.post(
        f"{API}/designs", json={"name": "own", "steps": {id: step}}, headers={"Prefer": "wait=30"}
    )
    return f"/designs/{response.json()['id']}"


def settled(http, place: str, seconds: float = 60.0) -> dict:
    """The design of a page once its regeneration has ended."""

    def asked():
        http.get(f"{API}{place}/model.step", headers={"Prefer": "wait=10"})
        return http.get(f"{API}{place}").json()

    return until(asked, lambda design: design["state"] != "regenerating", seconds)
