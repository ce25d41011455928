"""Signing in with an OpenID provider requires the right proofs and gives the right principal."""

import base64
import hmac
import json
import time
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from serving import serving

from app.settings import Settings

pytest.importorskip("joserfc", reason="needs the extra team")
from joserfc import jwt
from joserfc.jwk import RSAKey

ISSUER = "https://provider.example"
HERE = {"Accept": "text/html"}


class FakeProvider:
    """Signs in whoever asks, as `claims` and `key` say; it checks the code verifier as a real one does."""

    def __init__(self):
        self.key = self.published = RSAKey.generate_key(2048, {"kid": "1"})
        self.claims, self.asked, self.token = {}, {}, self.signed

    def transport(self):
        return httpx.MockTransport(self.answer)

    def answer(self, request):
        place = request.url.path
        if place.endswith("openid-configuration"):
            ends = {"authorization_endpoint": "auth", "token_endpoint": "token", "jwks_uri": "keys"}
            return httpx.Response(
                200, json={"issuer": ISSUER, **{name: f"{ISSUER}/{end}" for name, end in ends.items()}}
            )
        if place == "/keys":
            return httpx.Response(200, json={"keys": [self.published.as_dict(private=False)]})
        sent = parse_qs(request.content.decode())
        from app.identity.oidc import Begun

        if Begun("", "", sent["code_verifier"][0]).challenge != self.asked["code_challenge"]:
            return httpx.Response(400, json={"error": "invalid_grant"})
        usual = {
            "iss": ISSUER,
            "aud": "crank",
            "sub": "ada-1",
            "name": "Ada W.",
            "exp": int(time.time()) + 60,
        }
        claims = {**usual, "nonce": self.asked["nonce"], **self.claims}
        return httpx.Response(200, json={"id_token": self.token(claims)})

    def signed(self, claims):
        return jwt.encode({"alg": "RS256", "kid": "1"}, claims, self.key)


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    data = tmp_path_factory.mktemp("oidc") / "data"
    with serving(Settings(data=data, oidc_issuer=ISSUER, oidc_client="crank")) as server:
        yield server


@pytest.fixture
def provider(monkeypatch):
    from app.identity import oidc

    fake = FakeProvider()
    monkeypatch.setattr(
        oidc.Provider, "_http", lambda self: httpx.AsyncClient(transport=fake.transport(), trust_env=False)
    )
    return fake


@pytest.fixture
def browser(service):
    with httpx.Client(base_url=service.url, timeout=90, trust_env=False, headers=HERE) as http:
        yield http


def brought_back(browser, provider, **changes):
    left = browser.get("/sign-in/oidc?back=/account")
    assert left.status_code == 303, left.text
    provider.asked = {
        name: text[0] for name, text in parse_qs(urlsplit(left.headers["location"]).query).items()
    }
    return browser.get(
        "/sign-in/oidc/back", params={"state": provider.asked["state"], "code": "c", **changes}
    )


def test_a_person_signs_in_and_has_no_roles_until_they_are_given(service, browser, provider):
    page = brought_back(browser, provider)
    assert page.status_code == 200, page.text
    assert "url=/account" in page.text
    assert "Ada W." in browser.get("/account").text
    assert browser.get("/designs").status_code == 403
    identity = service.app.state.services.identity
    row = identity.named("Ada W.")
    from app.identity.service import Changes

    identity.change(row.id, Changes(roles=["viewer"]))
    assert browser.get("/designs").status_code == 200
    assert brought_back(browser, provider).status_code == 200
    assert [one.id for one in identity.page(10)].count(row.id) == len(identity.page(10)) == 1


def test_with_a_provider_the_service_asks_before_there_is_anybody(service):
    assert httpx.get(f"{service.url}/api/v1/designs", trust_env=False, timeout=90).status_code == 401


@pytest.mark.parametrize(
    "claims",
    [{"aud": "another"}, {"iss": "https://evil.example"}, {"nonce": "replayed"}, {"exp": 1}, {"sub": ""}],
)
@pytest.mark.sampled(3)
def test_a_token_for_something_else_is_refused(browser, provider, claims):
    provider.claims = claims
    assert brought_back(browser, provider).status_code == 403


def test_a_token_of_another_signer_is_refused(browser, provider):
    provider.key = RSAKey.generate_key(2048, {"kid": "1"})
    assert brought_back(browser, provider).status_code == 403


def encoded(part):
    text = part if isinstance(part, bytes) else json.dumps(part).encode()
    return base64.urlsafe_b64encode(text).rstrip(b"=").decode()


def unsigned(claims):
    return f"{encoded({'alg': 'none', 'typ': 'JWT'})}.{encoded(claims)}."


def test_a_token_that_nobody_signed_is_refused(browser, provider):
    provider.token = unsigned
    assert brought_back(browser, provider).status_code == 403


def test_the_public_key_is_no_secret_to_sign_with(browser, provider):
    """The header says HMAC, and the signature is made with the key that everybody has."""

    def confused(claims):
        said = f"{encoded({'alg': 'HS256', 'kid': '1'})}.{encoded(claims)}"
        public = provider.published.as_pem(private=False)
        return f"{said}.{encoded(hmac.digest(public, said.encode(), 'sha256'))}"

    provider.token = confused
    assert brought_back(browser, provider).status_code == 403


def test_a_key_that_the_token_brings_along_is_not_taken(browser, provider):
    own = RSAKey.generate_key(2048, {"kid": "1"})
    header = {"alg": "RS256", "kid": "1", "jwk": own.as_dict(private=False)}
    provider.token = lambda claims: jwt.encode(header, claims, own)
    assert brought_back(browser, provider).status_code == 403


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"exp": -30}, 200),  # clocks may differ by a minute
        ({"exp": -90}, 403),
        ({"nbf": 30}, 200),
        ({"nbf": 90}, 403),
        ({"iat": 30}, 200),
        ({"iat": 600}, 403),
    ],
)
@pytest.mark.sampled(3)
def test_clocks_may_differ_by_a_minute(browser, provider, change, status):
    provider.claims = {name: int(time.time()) + seconds for name, seconds in change.items()}
    assert brought_back(browser, provider).status_code == status


@pytest.mark.parametrize(
    ("claims", "status"),
    [
        ({"aud": ["crank"]}, 200),
        ({"aud": ["crank"], "azp": "crank"}, 200),
        ({"aud": ["crank", "another"], "azp": "crank"}, 200),
        ({"aud": ["crank", "another"]}, 403),
        ({"aud": ["another", "crank", "third"]}, 403),
        ({"aud": ["crank", "another"], "azp": None}, 403),
        ({"aud": ["crank", "another"], "azp": ["crank"]}, 403),
        ({"aud": ["crank"], "azp": "another"}, 403),
        ({"aud": "crank", "azp": ""}, 403),
        ({"aud": ["another", "third"], "azp": "crank"}, 403),
        ({"aud": ["crank", "another"], "azp": "another"}, 403),
        ({"aud": "crank", "azp": "another"}, 403),
        ({"aud": ["another"]}, 403),
        ({"aud": None}, 403),
        ({"nonce": None}, 403),
        ({"exp": None}, 403),
        ({"exp": "never"}, 403),
        ({"sub": 5}, 403),
    ],
)
@pytest.mark.sampled(6)
def test_the_audience_and_what_has_to_be_there(browser, provider, claims, status):
    provider.claims = claims
    assert brought_back(browser, provider).status_code == status


def test_a_token_of_several_services_is_refused_with_the_reason(browser, provider):
    provider.claims = {"aud": ["crank", "another"]}
    page = brought_back(browser, provider)
    assert "does not name the one that requested it" in page.text
    assert browser.get("/designs").status_code in (303, 401), "nobody has signed in"


def test_a_sign_in_is_brought_back_once(browser, provider):
    """The cookie goes with the first way back: whoever learns state and code later has nothing to send."""
    assert brought_back(browser, provider).status_code == 200
    again = browser.get("/sign-in/oidc/back", params={"state": provider.asked["state"], "code": "c"})
    assert again.status_code == 403


def test_another_state_or_browser_is_refused(service, browser, provider):
    assert brought_back(browser, provider, state="guessed").status_code == 403
    with httpx.Client(base_url=service.url, timeout=90, trust_env=False) as other:
        assert other.get("/sign-in/oidc/back?state=a&code=b").status_code == 403


def test_a_person_who_cancels_is_not_signed_in(browser, provider):
    assert brought_back(browser, provider, error="access_denied").status_code == 403
