"""The service accepts the right hosts and origins locally, in a network, and behind a proxy."""

import asyncio
import re

import httpx
import pytest
from fastapi import FastAPI, Request
from pydantic import ValidationError

from app.http import gate, guard, problems
from app.http.access import COOKIE, HEADER, TheClient
from app.http.connections import AddressLimit
from app.http.limits import BodyLimits
from app.main import create_app
from app.settings import Settings
from app.settings.hosts import Authority, Hosts, is_loopback, parse
from app.web.shared.session import keep_session

BODY = BodyLimits(2**20, 10.0, 1000.0)
ADDRESSES = AddressLimit(100, ())


def send(app, method="GET", path="/healthz", base="http://localhost", **more):
    """An app's answer without a server; the host asked is that of `base` or of a header."""

    async def sent():
        transport = httpx.ASGITransport(app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url=base) as http:
            return await http.request(method, path, **more)

    return asyncio.run(sent())


class TestAuthorities:
    @pytest.mark.parametrize(
        ("text", "name", "port"),
        [
            ("localhost", "localhost", None),
            ("LocalHost:8000", "localhost", 8000),
            ("a.b-c.d_e:1", "a.b-c.d_e", 1),
            ("[::1]:8000", "::1", 8000),
            ("[0:0::0:1]", "::1", None),
            ("192.168.1.5:80", "192.168.1.5", 80),
            ("localhost.", "localhost", None),
            ("Crank.Example.:8443", "crank.example", 8443),
        ],
    )
    def test_what_is_one(self, text, name, port):
        assert parse(text) == Authority(name, port)

    @pytest.mark.parametrize(
        "text",
        [
            "",
            " ",
            "a b",
            "a:",
            ":80",
            "a:65536",
            "a:0",
            "[::1",
            "::1",
            "[g::]",
            "a..b",
            ".a",
            "a@b",
            "a/",
            "\u212a",
            "a\n",
        ],
    )
    def test_what_is_none(self, text):
        assert parse(text) is None

    def test_loopback(self):
        assert all(map(is_loopback, ["localhost", "127.0.0.1", "127.255.255.254", "::1"]))
        assert not any(
            map(is_loopback, ["0.0.0.0", "::", "128.0.0.1", "localhost.example", "::ffff:127.0.0.1"])
        )


class TestSetting:
    @pytest.mark.parametrize(
        "entry",
        [
            "http://a.example",
            "a.example/",
            "*",
            "*.",
            "*.example",
            "*.1.2.3.4",
            "a.*.example",
            "*a.example",
            "",
            "a b",
        ],
    )
    def test_what_is_no_host_is_refused_at_the_start(self, entry):
        with pytest.raises(ValidationError, match=r"is not a host: write crank\.example"):
            Settings(allowed_hosts=(entry,))

    def test_a_list_from_the_environment(self, monkeypatch):
        monkeypatch.setenv(
            "CRANKWRIGHT_ALLOWED_HOSTS", '["crank.example", "*.works.example:8443", "[2001:db8::7]"]'
        )
        assert Settings().allowed_hosts == ("crank.example", "*.works.example:8443", "[2001:db8::7]")

    @pytest.mark.parametrize(
        ("entry", "allowed", "refused"),
        [
            (
                "crank.example",
                ["crank.example", "CRANK.example:8000"],
                ["a.crank.example", "crank.example.evil"],
            ),
            ("crank.example:8443", ["crank.example:8443"], ["crank.example:8000"]),
            ("crank.example:443", ["crank.example", "crank.example:443"], ["crank.example:80"]),
            (
                "*.works.example",
                ["a.works.example", "a.b.works.example:1"],
                ["works.example", "aworks.example"],
            ),
            ("[2001:db8::7]", ["[2001:db8:0::7]:8000"], ["[2001:db8::8]"]),
        ],
    )
    @pytest.mark.sampled(2)
    def test_what_it_allows(self, entry, allowed, refused):
        app = create_app(Settings(allowed_hosts=(entry,)))
        for host in allowed:
            assert send(app, headers={"Host": host}).status_code == 200
        for host in refused:
            assert send(app, headers={"Host": host}).status_code == 421


class TestBoundAddress:
    SERVER = ("192.168.1.5", 8000)

    @pytest.mark.parametrize(
        ("bound", "host", "allowed"),
        [
            ("192.168.1.5", "192.168.1.5:8000", True),
            ("192.168.1.5", "192.168.1.5:9000", False),
            ("192.168.1.5", "192.168.1.6:8000", False),
            ("0.0.0.0", "192.168.1.5:8000", True),  # the address that the connection arrived at
            ("0.0.0.0", "0.0.0.0:8000", False),
            ("::", "[::]:8000", False),
            ("crank.example", "crank.example:8000", True),
            ("crank.example", "crank.example", False),  # that is port 80
            ("127.0.0.1", "crank.example:8000", False),
        ],
    )
    def test_is_allowed_with_its_port(self, bound, host, allowed):
        assert Hosts((), bound).allows(parse(host), "http", self.SERVER) is allowed

    def test_a_name_that_a_server_calls_itself_is_no_address(self):
        assert not Hosts().allows(parse("evil.example:8000"), "http", ("evil.example", 8000))
        assert not Hosts().allows(parse("evil.example"), "http", None)


class TestProxy:
    @pytest.mark.parametrize(
        ("origin", "host", "status"),
        [
            ("https://crank.example", "crank.example", 404),
            ("http://crank.example", "crank.example", 404),
            ("https://crank.example", "localhost:8000", 404),  # the proxy does not pass the host on
            ("https://crank.example:8443", "crank.example:8443", 404),
            ("https://a.works.example", "a.works.example", 404),
            ("https://crank.example:9000", "crank.example", 403),
            ("http://crank.example", "localhost:8000", 403),
            ("https://a.works.example", "localhost:8000", 403),  # a wildcard is not a name to trust elsewhere
            ("https://a.works.example", "b.works.example", 403),
            ("https://evil.example", "crank.example", 403),
            ("https://localhost:8000", "localhost:8000", 403),  # not https, and not listed
        ],
    )
    @pytest.mark.sampled(4)
    def test_origins_behind_one(self, origin, host, status):
        app = create_app(Settings(allowed_hosts=("crank.example", "*.works.example")))
        answer = send(app, "POST", "/nothing", headers={"Host": host, "Origin": origin})
        assert answer.status_code == status

    def test_https_of_our_own(self):
        app = create_app(Settings())
        own = {"Origin": "https://localhost:8443"}
        assert send(app, "POST", "/nothing", "https://localhost:8443", headers=own).status_code == 404
        own = {"Origin": "http://localhost:8443"}
        assert send(app, "POST", "/nothing", "https://localhost:8443", headers=own).status_code == 403


class TestSockets:
    def closed(self, *headers):
        reached, sent = [], []

        async def app(scope, receive, send):
            reached.append(scope)

        async def take(message):
            sent.append(message)

        scope = {"type": "websocket", "scheme": "ws", "path": "/", "headers": [*headers], "server": None}
        asyncio.run(gate.Gate(app, Hosts(), BODY, ADDRESSES, problems.refusal)(scope, None, take))
        return not reached and sent[0]["type"] == "websocket.close"

    def test_other_sites_open_no_web_socket(self):
        host = (b"host", b"localhost:8000")
        assert self.closed((b"host", b"evil.example"))
        assert self.closed(host, (b"origin", b"http://evil.example"))
        assert self.closed(host, (b"sec-fetch-site", b"cross-site"))
        assert not self.closed(host, (b"origin", b"http://localhost:8000"))


class TestHeaders:
    def test_an_unexpected_error_carries_them(self):
        app = create_app(Settings())

        @app.get("/fails")
        async def fails() -> None:
            raise RuntimeError

        answer = send(app, path="/fails")
        assert answer.status_code == 500
        assert answer.headers["content-security-policy"] == guard.POLICY
        assert answer.headers["cross-origin-resource-policy"] == "same-origin"

    def test_what_a_route_says_stays(self):
        app = FastAPI()
        gate.install(app, Hosts(), BODY, ADDRESSES, problems.refusal)

        @app.get("/own")
        async def own() -> problems.Response:
            return problems.Response(headers={"X-Frame-Options": "SAMEORIGIN"})

        assert send(app, path="/own").headers.get_list("x-frame-options") == ["SAMEORIGIN"]


class TestSession:
    def page(self, **more):
        app = FastAPI()

        @app.get("/")
        async def show(request: Request) -> problems.Response:
            answer = problems.Response()
            keep_session(request, answer)
            return answer

        return send(app, path="/", **more).headers.get_list("set-cookie")

    def test_a_cookie_of_128_random_bits(self):
        (cookie,), (other,) = self.page(), self.page()
        assert re.fullmatch(rf"{COOKIE}=[\w-]{{22}}; HttpOnly; Path=/; SameSite=strict", cookie)
        assert cookie != other

    def test_it_is_secure_over_https(self):
        assert "Secure" in self.page(base="https://localhost")[0]

    def test_a_good_one_is_kept_and_a_bad_one_replaced(self):
        assert self.page(headers={"Cookie": f"{COOKIE}={'a' * 22}"}) == []
        for bad in ("short", "a" * 65, "a" * 22 + "%00"):
            assert len(self.page(headers={"Cookie": f"{COOKIE}={bad}"})) == 1


class TestCaller:
    @pytest.fixture
    def app(self):
        """A route that says for whom it is called, behind the guard."""
        app = FastAPI()
        gate.install(app, Hosts(), BODY, ADDRESSES, problems.refusal)

        @app.get("/api/v1/who")
        async def who(client: TheClient) -> dict[str, str]:
            return {"client": client}

        return app

    @pytest.mark.parametrize(
        ("headers", "client"),
        [
            ({"Cookie": f"{COOKIE}={'a' * 22}"}, f"session:{'a' * 22}"),
            ({HEADER: "design office"}, "name:design office"),
            ({}, "address:127.0.0.1"),
        ],
    )
    def test_the_client_is_the_session_the_name_or_the_address(self, app, headers, client):
        assert send(app, path="/api/v1/who", headers=headers).json() == {"client": client}
