"""The route of Plotly's browser file."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.web.plots import plotly

router = APIRouter(include_in_schema=False)


@router.get("/static/plotly.min.js")
async def plotly_script(request: Request) -> Response:
    """Return Plotly's browser file, compressed; it changes only if its package does."""
    headers = {"ETag": plotly.tag(), "Cache-Control": "public, max-age=3600", "Content-Encoding": "gzip"}
    if request.headers.get("if-none-match") == plotly.tag():
        return Response(status_code=304, headers={"ETag": plotly.tag()})
    return Response(plotly.script(), media_type="text/javascript", headers=headers)
