"""The MCP server: its list of tools, their calls, and the resources."""

from __future__ import annotations

import logging
from importlib.metadata import version

import anyio
import mcp_types as mcp
from mcp.server.context import ServerRequestContext
from mcp.server.lowlevel.server import Server
from mcp.server.stdio import stdio_server
from mcp.shared.exceptions import MCPError
from pydantic import JsonValue
from starlette.requests import Request

from app.agents.calls import AnswerStore, Call
from app.agents.errors import Refused, message
from app.agents.replies import Reply, refusal
from app.agents.resources import LINKS, SKILL, SKILL_TYPE, contents
from app.agents.tools import TOOLS, Tool
from app.client import Problem

logger = logging.getLogger(__name__)

Context = ServerRequestContext[dict[str, JsonValue], Request]
BEARER = "bearer "
INSTRUCTIONS = f"Engine-bearing calculations that drive CAD. Read {SKILL} first."


class AgentServer:
    """The handlers of the protocol; every call goes to one service, with the key of its caller.

    Parameters
    ----------
    url
        Address of the service.
    key
        Key of the only caller; over HTTP each request brings its own.
    """

    def __init__(self, url: str, key: str | None = None) -> None:
        self.url, self.key, self.answers = url, key, AnswerStore()

    def protocol(self) -> Server[dict[str, JsonValue]]:
        """Return the server of the protocol with these handlers."""
        return Server(
            "crankwright",
            version=version("crankwright"),
            instructions=INSTRUCTIONS,
            on_list_tools=self.list_tools,
            on_call_tool=self.call_tool,
            on_list_resources=self.list_resources,
            on_list_resource_templates=self.list_links,
            on_read_resource=self.read_resource,
        )

    async def list_tools(
        self, context: Context, params: mcp.PaginatedRequestParams | None
    ) -> mcp.ListToolsResult:
        """Return the tools."""
        return mcp.ListToolsResult(tools=[listed(name, tool) for name, tool in TOOLS.items()])

    async def call_tool(self, context: Context, params: mcp.CallToolRequestParams) -> mcp.CallToolResult:
        """Call a tool; a refusal is a result that is marked as an error."""
        tool = TOOLS.get(params.name)
        if tool is None:
            return refusal(f"There is no such tool. The tools are {', '.join(TOOLS)}.")
        try:
            call = self._call(context)
            async with call.service:
                return (await tool.run(call, params.arguments or {})).result()
        except Exception as error:
            return refusal(self._message(error))

    async def list_resources(
        self, context: Context, params: mcp.PaginatedRequestParams | None
    ) -> mcp.ListResourcesResult:
        """Return the resources with a fixed name: the skill."""
        skill = mcp.Resource(uri=SKILL, name="skill", mime_type=SKILL_TYPE)
        return mcp.ListResourcesResult(resources=[skill])

    async def list_links(
        self, context: Context, params: mcp.PaginatedRequestParams | None
    ) -> mcp.ListResourceTemplatesResult:
        """Return how resources of the service are named."""
        return mcp.ListResourceTemplatesResult(resource_templates=[LINKS])

    async def read_resource(
        self, context: Context, params: mcp.ReadResourceRequestParams
    ) -> mcp.ReadResourceResult:
        """Return a resource; a refusal is an error of the protocol."""
        try:
            call = self._call(context)
            async with call.service:
                return await contents(call, str(params.uri))
        except Exception as error:
            code = mcp.INVALID_PARAMS if isinstance(error, (Refused, Problem)) else mcp.INTERNAL_ERROR
            raise MCPError(code, self._message(error)) from None

    def _call(self, context: Context) -> Call:
        """Open a call with the key of the request, or of the only caller."""
        key = self.key if context.request is None else key_of(context.request)
        try:
            return Call.of(self.url, key, self.answers)
        except ValueError as error:
            raise Refused(f"Authorization: {error}") from None

    def _message(self, error: Exception) -> str:
        """Return a refusal as text; log a fault of this program, and say no more than that it happened."""
        if (text := message(error, self.url)) is not None:
            return text
        logger.error("a tool failed", exc_info=error)
        return "The tool failed because of a fault of this program; its log says more."


def key_of(request: Request) -> str | None:
    """Return the key in the header `Authorization: Bearer`; None without one."""
    header = request.headers.get("Authorization", "")
    return header[len(BEARER) :].strip() if header.lower().startswith(BEARER) else None


def listed(name: str, tool: Tool) -> mcp.Tool:
    """Return a tool as the list of tools shows it."""
    writes = {} if tool.reads_only else {"destructive_hint": False}
    return mcp.Tool(
        name=name,
        description=tool.words,
        input_schema=tool.arguments.input_schema(),
        output_schema=Reply.output_schema(),
        annotations=mcp.ToolAnnotations(read_only_hint=tool.reads_only, open_world_hint=False, **writes),
    )


def serve_stdio(url: str, key: str | None) -> None:
    """Serve one caller over stdin and stdout until stdin ends; all else that is printed goes to stderr."""
    anyio.run(_serve, AgentServer(url, key).protocol())


async def _serve(protocol: Server[dict[str, JsonValue]]) -> None:
    async with stdio_server() as (reading, writing):
        await protocol.run(reading, writing, protocol.create_initialization_options())
