"""Requests generated from the OpenAPI document: never a 5xx, and every refusal is a problem."""

import httpx
import pytest
import schemathesis
from hypothesis import settings
from serving import HANG
from test_openapi_fuzz import QUICK

from app.main import create_app
from app.settings import Settings

# A stream of events has no end.
INTERFACE = schemathesis.openapi.from_dict(create_app(Settings()).openapi()).exclude(path_regex="/events$")


@schemathesis.serializer("model/step", "application/zip")
def as_bytes(context, value):
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "replace")


def ask(case, url):
    headers = {"Prefer": "respond-async"}
    if case.method == "PATCH":
        headers["If-Match"] = "*"
    answer = case.call(base_url=url, headers=headers, timeout=2 * HANG)
    assert answer.status_code < 500, answer.text
    if answer.status_code >= 400 and case.method != "HEAD":
        assert answer.headers["content-type"][0] == "application/problem+json", answer.text
    if answer.status_code == 202:  # work that may take minutes: seen, and taken away
        httpx.delete(f"{url}{answer.headers['location'][0]}", timeout=HANG, trust_env=False)


@pytest.mark.slow
@INTERFACE.parametrize()
@settings(QUICK, max_examples=300)
def test_the_interface_at_length(served, case):
    ask(case, served.url)
