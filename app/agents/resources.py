"""Resources: what the service returns to GET, files included; full answers; and the skill."""

from __future__ import annotations

import base64
import re

import httpx
import mcp_types as mcp

from app.agents.calls import Call
from app.agents.errors import Refused
from app.agents.replies import SCHEME
from app.agents.skill import skill
from app.client.exchange import Exchange, awaited, get

SKILL = f"{SCHEME}skill"
SKILL_TYPE = "text/markdown"
_PATH = re.compile(r"(?:/[A-Za-z0-9_~-][A-Za-z0-9._~-]{0,200}){1,12}(?:\?[A-Za-z0-9._~=&%+-]{0,1000})?")
_TEXTS = ("text/", "application/json", "image/svg+xml", "application/problem+json")
LINKS = mcp.ResourceTemplate(
    uri_template=SCHEME + "{+path}",
    name="service",
    description="GET /api/v1/{path}: designs/ID/model.step, designs/ID/report.pdf, templates/ID/versions/N",
)


async def contents(call: Call, uri: str) -> mcp.ReadResourceResult:
    """Return a resource with the caller's key.

    Raises
    ------
    Refused
        If there is no such resource.
    Problem
        If the service refuses the request.
    """
    path = path_of(uri)
    if uri == SKILL:
        return _text(uri, skill(), SKILL_TYPE)
    if path.startswith("/answers/"):
        answer = call.answers.find(call.owner, path.removeprefix("/answers/"))
        if answer is None:
            raise Refused("no such answer; only the newest are stored, so call the tool again")
        return _text(uri, answer, "application/json")
    response = await call.service.run(fetched(path))
    kind = response.headers.get("Content-Type", "application/octet-stream").partition(";")[0]
    if kind.startswith(_TEXTS):
        return _text(uri, response.text, kind)
    blob = base64.b64encode(response.content).decode()
    return mcp.ReadResourceResult(contents=[mcp.BlobResourceContents(uri=uri, blob=blob, mime_type=kind)])


def path_of(uri: str) -> str:
    """Return the path below the interface that a resource names.

    Raises
    ------
    Refused
        If it names none, or a stream of events, which never ends.
    """
    path = "/" + uri.removeprefix(SCHEME)
    if not uri.startswith(SCHEME) or not _PATH.fullmatch(path) or path.partition("?")[0].endswith("/events"):
        raise Refused(f"a resource is {SCHEME} and a path of the interface, such as {SCHEME}templates")
    return path


def fetched(path: str) -> Exchange[httpx.Response]:
    """Return what the service sends for a path, once it has been created."""
    return awaited(get(path))


def _text(uri: str, text: str, kind: str) -> mcp.ReadResourceResult:
    return mcp.ReadResourceResult(contents=[mcp.TextResourceContents(uri=uri, text=text, mime_type=kind)])
