"""Sign in through an OpenID provider: authorization code with state, nonce and PKCE.

The protocol is OpenID Connect Core 1.0, section 3.1, and RFC 7636. It needs the extra `team`, whose packages
are imported where they are used.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

import httpx

from app.identity.errors import IdentityError
from app.settings import Settings

DISCOVERY = "/.well-known/openid-configuration"
SIGNED_BY = ["RS256", "PS256", "ES256", "EdDSA"]
_PATIENCE = 10.0  # longest wait for the provider [s]
_BYTES = 32
_LONGEST_NAME = 90  # characters


class ProviderRefused(IdentityError):
    """The provider did not identify the person, or its statement cannot be trusted."""


@dataclass(frozen=True)
class Begun:
    """A sign-in that has begun: the values that the browser keeps until the provider redirects it back."""

    state: str
    nonce: str
    verifier: str

    @property
    def challenge(self) -> str:
        """Return the hash of the verifier to send to the provider (RFC 7636, S256)."""
        hashed = hashlib.sha256(self.verifier.encode()).digest()
        return base64.urlsafe_b64encode(hashed).rstrip(b"=").decode()


@dataclass(frozen=True)
class Person:
    """A person who has signed in, as the provider states; the provider and `subject` identify them."""

    subject: str
    name: str


def begin() -> Begun:
    """Return a new sign-in with random state, nonce and verifier."""
    return Begun(*(secrets.token_urlsafe(_BYTES) for _ in range(3)))


class Provider:
    """The OpenID provider of the settings."""

    def __init__(self, settings: Settings, transport: httpx.AsyncBaseTransport | None = None) -> None:
        if settings.oidc_issuer is None or settings.oidc_client is None:
            raise ProviderRefused("the service has no provider: set CRANKWRIGHT_OIDC_ISSUER and _CLIENT")
        self.issuer, self.client = settings.oidc_issuer.rstrip("/"), settings.oidc_client
        self._secret = settings.oidc_secret.get_secret_value() if settings.oidc_secret else None
        self._transport = transport

    async def address(self, begun: Begun, back: str) -> str:
        """Return the address at which the browser signs in; the provider redirects it to `back`.

        Raises
        ------
        ProviderRefused
            If the provider does not answer, or not correctly.
        """
        async with self._http() as http:
            place = _text(await self._about(http), "authorization_endpoint")
        query = {
            "response_type": "code",
            "client_id": self.client,
            "redirect_uri": back,
            "scope": "openid profile email",
            "state": begun.state,
            "nonce": begun.nonce,
            "code_challenge": begun.challenge,
            "code_challenge_method": "S256",
        }
        return f"{place}{'&' if '?' in place else '?'}{urlencode(query)}"

    async def person(self, begun: Begun, state: str, code: str, back: str) -> Person:
        """Return the person who has signed in, by the code that the browser brought back.

        Raises
        ------
        ProviderRefused
            If the state differs, the code is refused, or the token was not signed for this sign-in.
        """
        if not hmac.compare_digest(state.encode(), begun.state.encode()):
            raise ProviderRefused("this sign-in did not start in this browser: sign in again")
        sent = {
            "grant_type": "authorization_code",
            "code": code,
            "redirect_uri": back,
            "client_id": self.client,
            "code_verifier": begun.verifier,
            **({"client_secret": self._secret} if self._secret else {}),
        }
        async with self._http() as http:
            about = await self._about(http)
            answer = await _asked(http, "POST", _text(about, "token_endpoint"), sent)
            keys = await _asked(http, "GET", _text(about, "jwks_uri"))
        claims = self._verified(_text(answer, "id_token"), keys, begun.nonce)
        subject = _text(claims, "sub")
        named = [claims.get(field) for field in ("name", "preferred_username", "email")]
        name = next((text.strip() for text in named if isinstance(text, str) and text.strip()), subject)
        return Person(f"{self.issuer} {subject}", " ".join(name.split())[:_LONGEST_NAME])

    def _verified(self, token: str, keys: Mapping[str, object], nonce: str) -> Mapping[str, object]:
        """Return the claims of a token that the provider signed for this service and this sign-in."""
        try:
            from joserfc import jwt
            from joserfc.errors import JoseError
            from joserfc.jwk import KeySet
        except ModuleNotFoundError:
            raise ProviderRefused("the service lacks a package: pip install crankwright[team]") from None
        try:
            claims = jwt.decode(token, KeySet.import_key_set(keys), algorithms=SIGNED_BY).claims  # type: ignore[arg-type]  # the decoder checks them
            jwt.JWTClaimsRegistry(
                leeway=60,
                iss={"essential": True, "value": self.issuer},
                aud={"essential": True, "value": self.client},
                nonce={"essential": True, "value": nonce},
                exp={"essential": True},
                sub={"essential": True},
            ).validate(claims)
        except (JoseError, ValueError, KeyError, TypeError) as error:
            raise ProviderRefused(f"the provider's token is not valid: {type(error).__name__}") from None
        self._require_own(claims)
        return claims

    def _require_own(self, claims: Mapping[str, object]) -> None:
        """Refuse a token that another service requested: OpenID Connect Core 1.0, section 3.1.3.7, 4 and 5.

        A token for several services (`aud`) names the requesting service (`azp`), which must be this one.
        """
        audience = claims["aud"]
        if "azp" not in claims and isinstance(audience, list) and len(audience) > 1:
            raise ProviderRefused(
                "the provider's token is for several services and does not name the one that requested it"
            )
        if claims.get("azp", self.client) != self.client:
            raise ProviderRefused("the provider's token is for another service")

    async def _about(self, http: httpx.AsyncClient) -> Mapping[str, object]:
        about = await _asked(http, "GET", self.issuer + DISCOVERY)
        if _text(about, "issuer").rstrip("/") != self.issuer:
            raise ProviderRefused("the provider's issuer differs from CRANKWRIGHT_OIDC_ISSUER")
        return about

    def _http(self) -> httpx.AsyncClient:
        return httpx.AsyncClient(transport=self._transport, timeout=_PATIENCE, trust_env=False)


async def _asked(
    http: httpx.AsyncClient, method: str, place: str, sent: Mapping[str, str] | None = None
) -> Mapping[str, object]:
    """Return the provider's answer to a request; messages quote no part of it."""
    try:
        answer = await http.request(method, place, data=sent)
        content: object = answer.json() if answer.is_success else None
    except (httpx.HTTPError, httpx.InvalidURL, ValueError):
        content = None
    if not isinstance(content, dict):
        raise ProviderRefused("the provider does not answer, or refuses the request")
    return content


def _text(about: Mapping[str, object], name: str) -> str:
    text = about.get(name)
    if not isinstance(text, str) or not text:
        raise ProviderRefused(f"the provider does not state its {name}")
    return text
