"""The OpenAPI document at /openapi.json, corrected to match the service, and its page /docs.

FastAPI derives the document from the routes. Four points are corrected here: a parameter of a path, query or
header cannot be null; a change needs If-Match; a name that does not fit the pattern of names is refused;
`itemSchema` belongs to OpenAPI 3.2. Some parts are rewritten in a form that client generators understand.
The problems that follow from an operation's parameters and body are added here too; a route declares only its
other problems.

FastAPI's dictionaries are nested to any depth, so their values have the type `Any`.
"""

from __future__ import annotations

import hashlib
import re
from base64 import b64encode
from collections.abc import Iterator
from typing import Any

from fastapi import APIRouter, FastAPI
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse
from fastapi.routing import APIRoute

from app.http.answer_examples import add_examples
from app.schemas.problems import Fault, Problem, refusals

REFERENCE = "#/components/schemas/{model}"
TAGS = {
    "templates": "Calculations: what each needs and returns; evaluate one, solve it, write it out.",
    "curves": "Tables of measured values, read as curves.",
    "designs": "Calculations and models tied by relations, with their revisions, results and criteria.",
    "answers": "From requirements to the values that meet them, with the proof.",
    "variants": "Variants of a design, and the table that compares them.",
    "files": "STEP, meshes, drawings and pictures of the models of a design.",
    "reports": "Reports of a design on screen and paper, and its calculations written out.",
    "studies": "Many calculations of a design: grids, samples, sensitivities, optima.",
    "approvals": "Signatures, comments and releases of revisions.",
    "models": "CAD models without a design: build, analyse, verify, import.",
    "worksheets": "Calculations that engineers write as text.",
    "library": "Tables of materials, oils and sizes.",
    "jobs": "Long work, its progress and its results.",
    "problems": "The meaning of an error.",
    "principals": "People and programs, their roles and keys.",
    "audit": "The record of all changes.",
    "operations": "Health and metrics of the service.",
}
"""The groups of operations in the order in which a user meets them, and what each is about."""
VARIATIONS = (
    ("/revisions/{number}", "_of_revision", " of a Revision"),
    ("/models/{name}", "_of_model", ", by Model"),
    (".{kind}", "_as", ", by Format"),
)


def operation_id(route: APIRoute) -> str:
    """Return the name of an operation in a generated client.

    It is the name of the route's function, such as `evaluate_template`, with a suffix if the function serves
    several paths, such as `show_report_of_revision_as`.
    """
    return route.name + "".join(end for end, _ in _variations(route))


def summary(route: APIRoute) -> str:
    """Return the title of an operation, such as `Show Report of a Revision, by Format`."""
    return route.name.replace("_", " ").title() + "".join(words for _, words in _variations(route))


def _variations(route: APIRoute) -> list[tuple[str, str]]:
    """Return the ends of the name and of the title by which the paths of one function differ."""
    if not route.name.endswith(("_report", "_worksheet", "_file", "show_variant", "show_variants")):
        return []
    return [(end, words) for part, end, words in VARIATIONS if part in route.path]


def include(app: FastAPI, router: APIRouter) -> None:
    """Add the routes of a router to the app itself, with the app's responses and names.

    FastAPI would keep an included router as a whole, and search it twice for each request.
    """
    for route in router.routes:
        if isinstance(route, APIRoute):
            route.responses = {**app.router.responses, **route.responses}
            route.unique_id = route.operation_id or operation_id(route)
            route.summary = route.summary or summary(route)
        app.router.routes.append(route)


def describe_interface(app: FastAPI) -> dict[str, Any]:
    """Return the OpenAPI 3.1 description of the application."""
    if app.openapi_schema is None:
        FastAPI.openapi(app)
        assert app.openapi_schema is not None
        for method, operation in _operations(app.openapi_schema):
            _drop_item_schemas(operation)
            _drop_nulls(operation)
            _declare_preconditions(method, operation)
            _declare_problems(operation)
        app.openapi_schema["tags"] = [{"name": name, "description": text} for name, text in TAGS.items()]
        schemas = app.openapi_schema["components"]["schemas"]
        for _, operation in _operations(app.openapi_schema):
            _name_bodies(operation, schemas)
        for model in (Problem, Fault):
            schemas[model.__name__] = model.model_json_schema(ref_template=REFERENCE)
            schemas[model.__name__].pop("$defs", None)
        for schema in schemas.values():
            _simplify(schema)
        add_examples(app.openapi_schema)
    return app.openapi_schema


def _operations(described: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for item in described["paths"].values():
        yield from item.items()


def _name_bodies(operation: dict[str, Any], schemas: dict[str, Any]) -> None:
    """Name the inline objects of an operation, so that generators create one class for each."""
    for content in operation.get("requestBody", {}).get("content", {}).values():
        schema = content["schema"]
        if schema.get("type") == "object" and "title" in schema:
            schemas[schema["title"]] = schema
            content["schema"] = {"$ref": REFERENCE.format(model=schema["title"])}


def _drop_item_schemas(operation: dict[str, Any]) -> None:
    for response in operation["responses"].values():
        for content in response.get("content", {}).values():
            content.pop("itemSchema", None)


def _drop_nulls(operation: dict[str, Any]) -> None:
    """Remove null from optional parameters: a URL or header cannot contain null."""
    for parameter in operation.get("parameters", ()):
        schema = parameter["schema"]
        kinds = [kind for kind in schema.get("anyOf", ()) if kind != {"type": "null"}]
        if len(kinds) == 1:
            del schema["anyOf"]
            parameter["schema"] = {**kinds[0], **schema}


CHANGES = frozenset({"PATCH", "PUT", "DELETE"})
"""The methods that need If-Match, where the route compares it."""


def _declare_preconditions(method: str, operation: dict[str, Any]) -> None:
    """Declare If-Match: PATCH, PUT and DELETE need it; every other route compares it if it is sent."""
    matching = [one for one in operation.get("parameters", ()) if one["name"] == "if-match"]
    if not matching:
        return
    is_change = method.upper() in CHANGES
    matching[0]["required"] = is_change
    _refused(operation, *((412, 428) if is_change else (412,)))


def _declare_problems(operation: dict[str, Any]) -> None:
    """Declare the problems of every operation that has a body or a parameter, or uses stored rows."""
    if "requestBody" in operation:
        _refused(operation, 408, 413, 415, 422)
    if operation.get("parameters"):
        _refused(operation, 422)
    if operation["tags"] not in (["operations"], ["problems"]):
        _refused(operation, 503)


def _refused(operation: dict[str, Any], *statuses: int) -> None:
    for status, response in refusals(*statuses).items():
        operation["responses"].setdefault(str(status), response)


def _simplify(schema: Any) -> None:
    """Express the schema in a form that client generators understand, recursively.

    Names with a pattern become `propertyNames` without other properties; a single allowed text becomes an
    enumeration of one (openapi-python-client compares every value of a union with a `const`).
    """
    if isinstance(schema, list):
        for part in schema:
            _simplify(part)
    if isinstance(schema, dict):
        if len(schema.get("patternProperties", ())) == 1:
            ((pattern, values),) = schema.pop("patternProperties").items()
            schema.update(propertyNames={"pattern": pattern}, additionalProperties=values)
        if isinstance(schema.get("const"), str):
            schema["enum"] = [schema.pop("const")]
        for part in schema.values():
            _simplify(part)


FILES = "/static-offline-docs"  # where fastapi_offline serves Swagger UI
_INLINE = re.compile(rb"<script>(.*?)</script>", re.DOTALL)


def install(app: FastAPI) -> None:
    """Install `/docs`, Swagger UI from local files.

    Its script contains the present `app.swagger_ui_parameters`.
    """
    page = get_swagger_ui_html(
        openapi_url=app.openapi_url or "/openapi.json",
        title=f"{app.title} - Swagger UI",
        swagger_js_url=f"{FILES}/swagger-ui-bundle.js",
        swagger_css_url=f"{FILES}/swagger-ui.css",
        swagger_favicon_url=f"{FILES}/favicon.png",
        swagger_ui_parameters=app.swagger_ui_parameters,
    )
    headers = {"Content-Security-Policy": policy(bytes(page.body))}

    @app.get("/docs", include_in_schema=False)
    async def docs() -> HTMLResponse:
        return HTMLResponse(page.body, headers=headers)


def policy(page: bytes) -> str:
    """Return the content security policy of a page with inline scripts.

    It allows only these inline scripts and content from this service.
    """
    digests = (b64encode(hashlib.sha256(script).digest()).decode() for script in _INLINE.findall(page))
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'self'; script-src 'self' {hashes}; img-src 'self' data:; object-src 'none'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
