"""Tools over stdio and over streamable HTTP: keys, roles, origins, and what is on stdout."""

import asyncio
import json
import os
import subprocess
import sys

import httpx
import pytest
from click.testing import CliRunner
from mcp import Client
from mcp_clients import http_client, over_http, stdio
from serving import paper

from app.agents.tools import TOOLS
from app.cli.main import main

NO_KEY = "cw_" + "a" * 10 + "_" + "b" * 43
LIST = {"jsonrpc": "2.0", "id": 1, "method": "tools/list", "params": {}}
FIND = {"name": "find", "arguments": {"words": "film"}}
FIND = {"name": "find", "arguments": {"words": "film"}}
ACCEPT = {"Accept": "application/json, text/event-stream"}


@pytest.fixture(scope="module")
def address(team):
    with over_http(team.server.url) as address:
        yield address


def posted(address, key=None, tool=None, **headers):
    body = LIST if tool is None else {**LIST, "method": "tools/call", "params": FIND}
    sent = ACCEPT | headers | ({"Authorization": f"Bearer {key}"} if key else {})
    return httpx.post(address, json=body, headers=sent, trust_env=False, timeout=60)


def called(address, key, name, /, **arguments):
    async def ask():
        async with http_client(address, key) as client:
            return await client.call_tool(name, arguments)

    return asyncio.run(ask())


def test_a_client_over_stdio_calculates_with_the_key_of_the_environment(team):
    async def ask():
        async with Client(stdio(team.server.url, CRANKWRIGHT_KEY=team.keys["viewer"])) as client:
            listed = await client.list_tools()
            found = await client.call_tool("find", {"words": "oil film"})
            draft = await client.call_tool("propose", {"document": paper()})
            return listed, found, draft

    listed, found, draft = asyncio.run(ask())
    assert len(listed.tools) <= 7
    assert not found.is_error
    assert draft.is_error
    assert draft.content[0].text.startswith("403 ")


def test_stdout_carries_the_protocol_only_though_the_service_is_down(tmp_path):
    """A host sends lines by hand: a good call, a call without a service, and no JSON at all."""
    meta = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "t", "version": "1"}}
    lines = [
        {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": meta},
        {"jsonrpc": "2.0", "method": "notifications/initialized"},
        {"jsonrpc": "2.0", "id": 2, "method": "tools/list"},
        {"jsonrpc": "2.0", "id": 3, "method": "tools/call", "params": FIND},
    ]
    sent = "\n".join([*map(json.dumps, lines), "this is not JSON", ""])
    environment = {**os.environ, "CRANKWRIGHT_URL": "http://127.0.0.1:9", "PYTHONWARNINGS": "default"}
    process = subprocess.Popen(
        [sys.executable, "-m", "app", "mcp"], env=environment, text=True, stdin=-1, stdout=-1, stderr=-1
    )
    process.stdin.write(sent)
    process.stdin.flush()
    answers = {}
    while 3 not in answers:
        line = process.stdout.readline()
        assert line, process.stderr.read()
        message = json.loads(line)
        assert message["jsonrpc"] == "2.0"
        answers[message.get("id")] = message
    out, _ = process.communicate(timeout=60)
    assert all(json.loads(line)["jsonrpc"] == "2.0" for line in out.splitlines())
    assert answers[3]["result"]["isError"] is True
    assert "does not answer" in answers[3]["result"]["content"][0]["text"]


def test_without_a_key_or_with_a_wrong_one_the_answer_is_that_of_the_interface(team, address):
    own = httpx.get(f"{team.server.url}/api/v1/me", trust_env=False)
    for answer in (posted(address), posted(address, NO_KEY), posted(address, "nonsense")):
        assert answer.status_code == own.status_code == 401
        assert answer.headers["WWW-Authenticate"] == own.headers["WWW-Authenticate"]
        assert answer.headers["Content-Type"] == "application/problem+json"
        assert answer.json()["type"] == own.json()["type"]


def test_a_page_of_another_origin_and_another_host_are_refused(team, address):
    key = team.keys["author"]
    for origin in ("http://evil.example", "null", "http://127.0.0.1.evil.example", "http://127.0.0.1:1"):
        answer = posted(address, key, Origin=origin)
        assert answer.status_code == 403, origin
        assert answer.headers["Content-Type"] == "application/problem+json"
        assert httpx.get(address, headers={"Origin": origin}, trust_env=False).status_code == 403
    assert posted(address, key, Host="evil.example").status_code in (400, 403, 421)
    assert posted(address, key, Origin=address.removesuffix("/mcp")).status_code == 200


def test_a_role_decides_and_nobody_can_release(team, address):
    refused = called(address, team.keys["viewer"], "propose", document=paper())
    assert refused.is_error
    assert "403" in refused.content[0].text
    assert "Remedy" in refused.content[0].text
    draft = called(address, team.keys["author"], "propose", document=paper())
    assert not draft.is_error
    id = draft.structured_content["rest"].rpartition("/")[2]
    for role in ("checker", "admin"):
        assert called(address, team.keys[role], "release", design=id).is_error
        assert called(
            address, team.keys[role], "propose", design=id, change={"approval": "released"}
        ).is_error
    with team.client("viewer") as client:
        assert client.approvals(id, 1).steps == []


def test_a_file_is_fetched_with_the_key_of_the_request(team, address):
    draft = called(address, team.keys["author"], "propose", document=paper())
    uri = f"{draft.structured_content['rest']}/model.step"

    async def read(key):
        async with http_client(address, key) as client:
            return await client.read_resource(uri)

    assert asyncio.run(read(team.keys["viewer"])).contents[0].mime_type == "model/step"
    with pytest.raises(Exception, match=r"401|unhandled errors"):
        asyncio.run(read(None))


def test_tools_without_keys_are_for_this_machine_only(served):
    with over_http(served.url, host="0.0.0.0") as address:
        answer = posted(address)
    assert answer.status_code in (403, 421)
    assert "keys add" in answer.json()["detail"]


def test_a_key_that_is_none_is_refused_in_words_where_the_service_needs_no_key(served):
    with over_http(served.url) as address:
        text = posted(address, "nonsense", tool="find").json()["result"]["content"][0]["text"]
    assert text.startswith("Refused: Authorization: this is not a key")


def test_the_environments_key_is_not_lent_to_callers_over_http(team, address, monkeypatch):
    monkeypatch.setenv("CRANKWRIGHT_KEY", team.keys["admin"])
    assert posted(address).status_code == 401


def test_the_command_prints_the_skill():
    printed = CliRunner().invoke(main, ["skill"]).output
    assert printed.startswith("---\nname: crankwright\n")
    assert all(f"`{name}`" in printed for name in TOOLS)


def test_a_missing_package_and_a_wrong_key_are_named_before_the_protocol_begins(monkeypatch):
    monkeypatch.setenv("CRANKWRIGHT_KEY", "secret")
    wrong = CliRunner().invoke(main, ["mcp"])
    assert wrong.exit_code == 1
    assert "CRANKWRIGHT_KEY: this is not a key" in wrong.stderr
    assert wrong.stdout == ""
    for name in [name for name in sys.modules if name.split(".")[0] in ("mcp", "mcp_types")]:
        monkeypatch.delitem(sys.modules, name)
    for name in [name for name in sys.modules if name.startswith("app.agents")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "mcp", None)
    monkeypatch.setitem(sys.modules, "mcp_types", None)
    missing = CliRunner().invoke(main, ["mcp"])
    assert "pip install 'crankwright[agents]'" in missing.stderr
    assert missing.stdout == ""
