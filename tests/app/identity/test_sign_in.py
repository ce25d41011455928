"""A browser signs in with a cookie; the forms of the session, redirects and its end are correct."""

import re

import pytest

from app.http.access import SIGN_IN
from app.identity.service import Changes

PAGE = {"Accept": "text/html"}


@pytest.fixture
def browser(team):
    with team.http(headers=PAGE) as http:
        yield http


def signed_in(browser, key, back="/account"):
    answer = browser.post("/sign-in", data={"key": key, "back": back})
    assert answer.status_code == 303, answer.text
    assert answer.headers["location"] == back
    return answer


def token_of(page):
    return re.search(r'name="form_token" value="([^"]+)"', page.text)[1]


def test_a_page_leads_to_the_sign_in_page_and_back(team, browser):
    asked = browser.get("/designs?name=a b")
    assert asked.status_code == 303
    assert asked.headers["location"] == "/sign-in?back=%2Fdesigns%3Fname%3Da%2520b"
    form = browser.get(asked.headers["location"])
    assert 'value="/designs?name=a%20b"' in form.text
    signed_in(browser, team.keys["viewer"], "/designs?name=a%20b")
    assert browser.get("/designs?name=a%20b").status_code == 200


def test_the_cookie_is_kept_from_scripts_and_other_sites_and_is_no_key(team, browser):
    cookie = signed_in(browser, team.keys["viewer"]).headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    assert "Secure" not in cookie  # this is http
    assert team.keys["viewer"][-43:] not in cookie


def test_the_cookie_is_secure_over_https(team):
    with team.http(headers={**PAGE, "X-Forwarded-Proto": "https"}) as http:
        answer = http.post("/sign-in", data={"key": team.keys["viewer"]})
    assert "Secure" in answer.headers["set-cookie"]  # uvicorn trusts a proxy on this machine


@pytest.mark.parametrize("key", ["", "cw_nothing", "x" * 5000])
def test_a_wrong_key_is_said_to_be_one(browser, key):
    answer = browser.post("/sign-in", data={"key": key})
    assert answer.status_code == 401
    assert "not valid" in answer.text
    assert SIGN_IN not in answer.headers.get("set-cookie", "")


@pytest.mark.parametrize(
    "back", ["//evil.example/", "https://evil.example", "/\\evil.example", "javascript:1"]
)
def test_the_way_back_stays_on_this_service(team, browser, back):
    answer = browser.post("/sign-in", data={"key": team.keys["viewer"], "back": back})
    assert answer.headers["location"] == "/"


def test_the_page_shows_who_has_signed_in_and_the_session_ends_by_signing_out(team, browser):
    signed_in(browser, team.keys["author"])
    page = browser.get("/account")
    assert re.search(r'href="/account">.*author.*</a>', page.text)
    cookie = browser.cookies[SIGN_IN]
    assert browser.post("/sign-out", data={"form_token": token_of(page)}).status_code == 303
    browser.cookies.set(SIGN_IN, cookie)
    assert browser.get("/account").status_code == 303


def test_a_form_of_no_session_is_refused_in_one(team, browser):
    signed_in(browser, team.keys["author"])
    refused = browser.post("/designs", data={"name": "from elsewhere", "form_token": "guessed"})
    assert refused.status_code == 403
    page = browser.get("/designs")
    response = browser.post("/designs", data={"name": "of this page", "form_token": token_of(page)})
    assert response.status_code == 303, response.text


def test_a_session_does_no_more_than_its_key_and_ends_with_it(team, browser):
    key, row = team.identity.add_key(team.principals["author"], scopes=["viewer"])
    signed_in(browser, key.text)
    assert browser.get("/designs").status_code == 200
    assert browser.post("/api/v1/designs", json={}).status_code == 403
    team.identity.revoke(row.prefix)
    assert browser.get("/designs").status_code == 303


def test_who_is_disabled_is_signed_out(team, browser):
    row = team.identity.add("short", ["viewer"])
    signed_in(browser, team.identity.add_key(row.id)[0].text)
    assert browser.get("/account").status_code == 200
    team.identity.change(row.id, Changes(disabled=True))
    assert browser.get("/account").status_code == 303


def test_keys_are_made_and_revoked_on_the_page_of_the_account(team, browser):
    signed_in(browser, team.keys["checker"])
    form = {"form_token": token_of(browser.get("/account")), "name": "bench", "days": "3"}
    page = browser.post("/account/keys", data=form)
    key = re.search(r"cw_([a-z0-9]{10})_[\w-]{43}", page.text)
    assert key
    assert key[0] not in browser.get("/account").text
    ended = browser.post(f"/account/keys/{key[1]}/revoke", data=form)
    assert ended.status_code == 303
    with team.http(headers={"Authorization": f"Bearer {key[0]}"}) as http:
        assert http.get("/api/v1/me").status_code == 401


def test_a_page_beyond_ones_role_says_which_is_needed(team, browser):
    signed_in(browser, team.keys["admin"])
    page = browser.get("/designs")
    assert page.status_code == 403
    assert "needs the role viewer" in page.text
