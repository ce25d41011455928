"""Pages of other origins in Chromium: their requests change nothing and get no answer."""

import json
import logging
import re
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from browsing import API, CHROMIUM, FLAGS, settled
from playwright.sync_api import expect

PATIENCE = 60_000  # for a part to be built [ms]

PAGE = """<!doctype html><title>hostile</title><iframe name="sink"></iframe><script type="module">
const { service, api, design, media } = JSON.parse(decodeURIComponent(location.hash.slice(1)));
const outcome = {};
window.outcome = outcome;
const place = `${api}/designs/${design}`;
const document_ = JSON.stringify({ name: "made by another site" });

async function fetched(name, path, options) {
  try {
    const answer = await fetch(service + path, options);
    outcome[name] = answer.type === "opaque" ? "sent" : `read ${answer.status} ${await answer.text()}`;
  } catch (error) { outcome[name] = "failed"; }
}
const event = (name, target, good) => new Promise((resolve) => {
  target.addEventListener(good, () => resolve(outcome[name] = "loaded"));
  target.addEventListener("error", () => resolve(outcome[name] = "failed"));
});
function loaded(name, tag, properties) {
  const element = Object.assign(document.createElement(tag), properties);
  document.body.append(element);
  return event(name, element, "load");
}
async function submitted(name, path, enctype, fields) {
  const form = document.createElement("form");
  Object.assign(form, { method: "post", action: service + path, enctype, target: "sink" });
  for (const [key, value] of Object.entries(fields)) {
    form.append(Object.assign(document.createElement("textarea"), { name: key, value }));
  }
  document.body.append(form);
  const done = event(name, document.querySelector("[name=sink]"), "load");
  form.submit();
  await done;
}
const post = (more) => ({ method: "POST", mode: "no-cors", ...more });

for (const [name, type] of Object.entries(media)) {
  const headers = type ? { "Content-Type": type } : {};
  await fetched(`create, ${name}`, `${api}/designs`, post({ body: new Blob([document_]), headers }));
}
await fetched("create, cors", `${api}/designs`, { method: "POST", body: document_ });
await fetched("create, json", `${api}/designs`,
  { method: "POST", body: document_, headers: { "Content-Type": "application/json" } });
for (const path of ["/copy", "/revisions/1/restore", "/auto-map?apply=true"]) {
  await fetched(path, place + path, post());
}
await fetched("delete", place, { method: "DELETE" });
await fetched("change", place, { method: "PATCH", body: "{}", headers: { "If-Match": "*" } });
await fetched("with cookies", `${place}/copy`, post({ credentials: "include" }));
await fetched("keepalive", `${place}/copy`, post({ keepalive: true }));
outcome.beacon = navigator.sendBeacon(`${service}${place}/copy`) ? "sent" : "failed";

await submitted("form", "/designs", "application/x-www-form-urlencoded", { example: "paper" });
await submitted("plain form", `${api}/designs`, "text/plain", { '{"name": "x", "note": "': '"}' });
await submitted("multipart form", "/designs", "multipart/form-data", { example: "paper" });
await submitted("delete form", `/designs/${design}/delete`, "application/x-www-form-urlencoded", {});

for (const path of ["/", "/healthz", "/metrics", "/openapi.json", `${api}/designs`, place]) {
  await fetched(`read ${path}`, path, {});
  await fetched(`load ${path}`, path, { mode: "no-cors" });
}
await loaded("image", "img", { src: `${service}${place}/model.png` });
await loaded("script", "script", { src: `${service}/static/design/design.js`, type: "module" });
await loaded("plain script", "script", { src: `${service}/static/plotly.min.js` });
await loaded("style", "link", { rel: "stylesheet", href: `${service}/static/shared/style.css` });
await event("events", new EventSource(`${service}${place}/events`), "open");
await event("socket", new WebSocket(service.replace("http", "ws") + place), "open");
for (const path of ["/", "/docs", `/designs/${design}`, `${place}/report.html`]) {
  await loaded(`frame ${path}`, "iframe", { src: service + path, className: "victim" });
}
window.done = true;
</script>"""

MEDIA = {
    "untyped": "",
    "text/plain": "text/plain",
    "form": "application/x-www-form-urlencoded",
    "multipart": "multipart/form-data",
}


class Hostile(BaseHTTPRequestHandler):
    def do_GET(self):
        body = PAGE.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *arguments):
        pass


@contextmanager
def hostile_site():
    """Another origin on this machine; its port."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Hostile)
    thread = threading.Thread(target=server.serve_forever, name="hostile")
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def state(http, place):
    """What a hostile page might change: designs, jobs, revisions."""
    designs, jobs = (http.get(f"{API}/{kind}?limit=100").json()["items"] for kind in ("designs", "jobs"))
    revisions = http.get(f"{API}{place}/revisions").json()
    return [one["id"] for one in designs], [one["id"] for one in jobs], revisions


def saves(page, place, url):
    """The service's own page saves a change."""
    page.goto(url + place)
    page.get_by_label("scale", exact=True).fill("1.01")
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text("revision 2", timeout=PATIENCE)
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=PATIENCE)


# Same site, another port, to which cookies are sent; another site.
@pytest.mark.slow
@pytest.mark.parametrize("site", ["127.0.0.1", "localhost"])
def test_a_page_of_another_origin(browser, served, http, paper, site, caplog):
    caplog.set_level(logging.INFO, "app.http.guard")
    context = browser.new_context()
    own, page = context.new_page(), context.new_page()
    own.goto(f"{served.url}/templates/third/1")  # the user has a session
    before = state(http, paper)
    wanted = {"service": served.url, "api": API, "design": paper.rpartition("/")[2], "media": MEDIA}
    with hostile_site() as port:
        page.goto(f"http://{site}:{port}/#{json.dumps(wanted)}")
        page.wait_for_function("window.done", timeout=PATIENCE)
        outcome = page.evaluate("window.outcome")
        framed = [frame.url for frame in page.frames[1:]]
    assert state(http, paper) == before
    refused = [record for record in caplog.records if record.name == "app.http.guard"]
    assert len(refused) == len(outcome) == 40  # each reached the service
    assert not {name: how for name, how in outcome.items() if how.startswith("read")}
    loads = ("image", "script", "plain script", "style", "events", "socket")
    assert {outcome[name] for name in loads} == {"failed"}
    assert {outcome[name] for name in outcome if name.startswith("load ")} == {"failed"}
    assert set(framed) == {"chrome-error://chromewebdata/"}  # what Chromium shows instead of a refused frame
    saves(own, paper, served.url)
    context.close()


def test_a_name_of_another_site_that_leads_here(browser, served, http, paper):
    """DNS rebinding: for the browser, all is one origin."""
    port = served.url.rpartition(":")[2]
    before = state(http, paper)
    rule = "--host-resolver-rules=MAP evil.example 127.0.0.1"
    other = browser.browser_type.launch(executable_path=CHROMIUM, args=[*FLAGS, rule])
    page = other.new_page(bypass_csp=True)  # a page that the site sent before its name changed has no policy
    for path in ("/", "/docs", f"{API}/designs", paper):
        assert page.goto(f"http://evil.example:{port}{path}").status == 421
    script = "async ([path, method]) => (await fetch(path, { method })).status"
    for method, path in (("GET", "/designs"), ("POST", f"{paper}/copy"), ("DELETE", paper)):
        assert page.evaluate(script, [f"{API}{path}", method]) == 421
    other.close()
    assert state(http, paper) == before


@pytest.mark.slow
def test_the_documentation_works_under_its_policy(watched, http):
    page = watched.page
    watched.open("/docs")
    call = page.locator("#operations-designs-create_design")
    call.click()
    call.get_by_text("Try it out").click()
    call.get_by_role("button", name="Execute").click()
    expect(call.locator(".live-responses-table .response-col_status").last).to_contain_text(
        "201", timeout=PATIENCE
    )
    design_id = http.get(f"{API}/designs?limit=1").json()["items"][0]["id"]
    settled(http, f"/designs/{design_id}")
    assert watched.faults() == []


def test_a_page_has_a_session_and_keeps_it(watched):
    watched.open("/")
    (cookie,) = [one for one in watched.page.context.cookies() if one["name"] == "crankwright_session"]
    assert (cookie["httpOnly"], cookie["sameSite"], cookie["path"]) == (True, "Strict", "/")
    assert not cookie["secure"]
    assert len(cookie["value"]) == 22
    watched.open("/designs")
    assert [one["value"] for one in watched.page.context.cookies()] == [cookie["value"]]
