"""Clients of the official package: in memory, over stdio, and over streamable HTTP."""

import asyncio
import json
import os
import sys
import threading
from contextlib import asynccontextmanager, contextmanager

import httpx2
import uvicorn
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client
from mcp.client.streamable_http import streamable_http_client
from mcp.shared.exceptions import MCPError
from serving import free_port, started

from app.agents.http import application
from app.agents.server import AgentServer

MOST_BYTES = 2000  # of an answer


def size(result):
    """The bytes of an answer as it goes over the wire."""
    return len(result.model_dump_json(by_alias=True, exclude_none=True).encode())


class Tools:
    """The tools of a server in memory, for one caller; each call is a connection of its own."""

    def __init__(self, url, key=None):
        self.server = AgentServer(url, key)

    def run(self, ask):
        async def asked():
            async with Client(self.server.protocol()) as client:
                try:
                    return await ask(client)
                except MCPError as error:  # the connection would wrap it into a group
                    return error

        answer = asyncio.run(asked())
        if isinstance(answer, MCPError):
            raise answer
        return answer

    def call(self, tool, /, **arguments):
        result = self.run(lambda client: client.call_tool(tool, arguments))
        assert size(result) <= MOST_BYTES, result
        return result

    def answer(self, tool, /, **arguments):
        result = self.call(tool, **arguments)
        assert not result.is_error, result.content[0].text
        return result.structured_content

    def refusal(self, tool, /, **arguments):
        result = self.call(tool, **arguments)
        assert result.is_error, result.structured_content
        return result.content[0].text

    def read(self, uri):
        return self.run(lambda client: client.read_resource(uri)).contents[0]

    def rest(self, answer):
        return json.loads(self.read(answer["rest"]).text)


def stdio(url, **environment):
    """The transport of a process `crankwright mcp`; give it to `Client`."""
    paths = {"PYTHONPATH": os.getcwd(), "CRANKWRIGHT_URL": url}
    return stdio_client(
        StdioServerParameters(command=sys.executable, args=["-m", "app", "mcp"], env=paths | environment)
    )


@contextmanager
def over_http(url, host="127.0.0.1"):
    """The address of the tools over streamable HTTP, in a thread."""
    port = free_port()
    config = uvicorn.Config(application(AgentServer(url), host), port=port, log_config=None)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    started(server, thread)
    try:
        yield f"http://127.0.0.1:{port}/mcp"
    finally:
        server.should_exit = True
        thread.join(30)


@asynccontextmanager
async def http_client(address, key=None, **headers):
    """A client of the tools at an address, with a key."""
    sent = headers | ({"Authorization": f"Bearer {key}"} if key else {})
    async with httpx2.AsyncClient(headers=sent, timeout=60) as http:
        async with Client(streamable_http_client(address, http_client=http)) as client:
            yield client
