"""Forms of a session contain its token; every page route that needs the token refuses a wrong or missing one.

The browser is signed in and everything else about the request is right, as if a page of this origin sent it.
"""

import re

import pytest
from described import APP
from fastapi.routing import iter_route_contexts

from app.http.access import SIGN_IN

FORMS = sorted(
    context.path
    for context in iter_route_contexts(APP.router.routes)
    if "POST" in (getattr(context.original_route, "methods", None) or ())
    and not context.path.startswith("/api")
)
PLAIN = ["/tables", "/verdicts"]
"""Asked by scripts of a page with JSON; nothing changes."""
URLENCODED = {"Content-Type": "application/x-www-form-urlencoded"}
MULTIPART = {"Content-Type": "multipart/form-data; boundary=cut"}
WITH_FILES = ["/worksheets/import", "/models/import", "/designs/{id}/variants/file", "/designs/{id}/variants"]


def filled(path):
    path = path.replace("{prefix}", "abcdefghij")
    return re.sub(r"\{(number|version)[^}]*\}", "1", re.sub(r"\{(?!number|version)[^}]*\}", "nothing", path))


@pytest.fixture(scope="module")
def browser(team):
    with team.http(headers={"Accept": "text/html"}) as http:
        key = team.identity.add_key(team.principals["checker"])[0].text
        assert http.post("/sign-in", data={"key": key}).status_code == 303
        yield http


@pytest.mark.parametrize("path", [path for path in FORMS if path not in PLAIN])
@pytest.mark.parametrize("body", ["", "form_token=guessed", "form_token="])
def test_a_form_without_the_token_of_its_session_is_refused(browser, path, body):
    answer = browser.post(filled(path), content=body, headers=URLENCODED)
    assert answer.status_code == 403, answer.text
    assert "the form belongs to another session" in answer.text


def parts(**fields):
    lines = [
        f'--cut\r\nContent-Disposition: form-data; name="{name}"\r\n\r\n{text}\r\n'
        for name, text in fields.items()
    ]
    file = (
        '--cut\r\nContent-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\na\r\n1\r\n--cut--\r\n'
    )
    return ("".join(lines) + file).encode()


@pytest.mark.parametrize("path", WITH_FILES)
@pytest.mark.parametrize("fields", [{}, {"form_token": "guessed"}, {"form_token": "\N{SNOWMAN}"}])
def test_a_form_with_a_file_carries_the_token_too(browser, path, fields):
    answer = browser.post(filled(path), content=parts(**fields), headers=MULTIPART)
    assert answer.status_code == 403, answer.text
    assert "the form belongs to another session" in answer.text


def test_pages_with_files_send_the_token_and_are_taken(browser):
    page = browser.get("/worksheets/import").text
    form = re.search(r'<form method="post" action="/worksheets/import".*?</form>', page, re.DOTALL)[0]
    token = re.search(r'name="form_token" value="([^"]+)"', form)[1]
    answer = browser.post("/worksheets/import", content=parts(form_token=token, id="a_b"), headers=MULTIPART)
    assert "the form belongs to another session" not in answer.text
    assert answer.status_code in (303, 422), answer.text


def test_every_form_of_a_page_that_changes_something_has_the_token(browser):
    for page in ("/", "/designs", "/worksheets", "/worksheets/import", "/account", "/sign-in"):
        forms = re.findall(r"<form\b[^>]*>(?:(?!</form>).)*</form>", browser.get(page).text, re.DOTALL)
        assert forms, page
        for form in forms:
            assert ('method="post"' in form) == ('name="form_token"' in form), form[:200]


def test_a_cookie_that_somebody_planted_is_not_the_session(team, browser):
    """Session fixation: the value of the cookie is always one that the service has just made."""
    planted = "A" * 43
    with team.http(headers={"Accept": "text/html"}, cookies={SIGN_IN: planted}) as http:
        assert http.get("/account").status_code == 303
        answer = http.post("/sign-in", data={"key": team.keys["viewer"]})
        given = re.search(rf"{SIGN_IN}=([^;]+)", answer.headers["set-cookie"])[1]
    assert given != planted
    with team.http(headers={"Accept": "text/html"}, cookies={SIGN_IN: planted}) as http:
        assert http.get("/account").status_code == 303


def test_signing_in_again_ends_the_session_that_the_browser_had(team):
    with team.http(headers={"Accept": "text/html"}) as http:
        http.post("/sign-in", data={"key": team.keys["viewer"]})
        before = http.cookies[SIGN_IN]
        token = re.search(r'name="form_token" value="([^"]+)"', http.get("/sign-in").text)[1]
        http.post("/sign-in", data={"key": team.keys["author"], "form_token": token})
        assert http.cookies[SIGN_IN] != before
    with team.http(headers={"Accept": "text/html"}, cookies={SIGN_IN: before}) as http:
        assert http.get("/account").status_code == 303
