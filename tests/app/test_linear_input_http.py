"""The request that froze the service, and similar ones, are answered by a refusal."""

import http.client
import socket
import subprocess
import sys
from io import BytesIO

import pytest
from openpyxl import load_workbook
from serving import API, HANG, created, problem

from app.designs.parameter_explanation import DEEPEST
from app.http.connections import LONGEST_HEAD
from app.http.limits import MOST_FIELDS, MOST_HEADERS
from tests.app.hostile_texts import EVERY

ANSWERED = {
    "Prefer of waits": 404,
    "Accept of commas": 200,
    "brackets in what was": 412,
    "19 000 fields": 303,
}
"""Those in which nothing but the length is strange."""

CHUNKED = b"POST /api/v1/designs HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"


@pytest.fixture(scope="module")
def any_design(http):
    return created(http, {"name": "any", "parameters": {"a": "1"}})["id"]


@pytest.mark.parametrize("request_", EVERY.values(), ids=EVERY)
@pytest.mark.sampled(16)
def test_it_is_answered(http, any_design, request_, request):
    method, path, headers, body = request_
    answer = http.request(method, path.format(design=any_design), headers=headers, content=body, timeout=HANG)
    expected = ANSWERED.get(request.node.callspec.id)
    assert answer.status_code == expected if expected else 400 <= answer.status_code < 500, answer.text[:500]
    assert len(answer.content) < 2 * 10**6
    if path.startswith(API) and answer.is_error:
        assert answer.headers["content-type"] == "application/problem+json"
        assert answer.json()["status"] == answer.status_code
    assert http.get("/healthz", timeout=HANG).is_success


def test_there_are_more_than_twenty_relatives():
    assert len(EVERY) > 20


def test_the_reproducer_as_it_was_reported(served):
    code = "print('FILE_DESCRIPTION((' + \"''\"*40, end='')"
    body = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout
    assert len(body) == 98
    connection = http.client.HTTPConnection(served.url.removeprefix("http://"), timeout=HANG)
    connection.request("POST", f"{API}/verify", body, {"Content-Type": "model/step"})
    assert connection.getresponse().status == 404
    connection.close()


def address(served):
    host, _, port = served.url.removeprefix("http://").partition(":")
    return host, int(port)


class TestHeads:
    def test_a_long_head_is_a_problem(self, http):
        answer = http.get("/healthz", headers={"X-Long": "a" * (LONGEST_HEAD + 1)})
        assert "64 KiB" in problem(answer, 431, "head-too-large")["detail"]

    def test_many_headers_are_a_problem(self, http):
        answer = http.get("/healthz", headers=[("A", "b")] * (MOST_HEADERS + 1))
        assert "200 headers" in problem(answer, 431, "head-too-large")["detail"]

    def test_many_fields_are_a_problem(self, http):
        assert http.get("/designs?" + "&".join(["a=1"] * MOST_FIELDS)).is_success
        answer = http.get("/designs?" + "&".join(["a=1"] * (MOST_FIELDS + 1)))
        assert "1000 fields" in problem(answer, 431, "head-too-large")["detail"]

    def test_a_head_below_the_limit_is_none(self, http):
        assert http.get("/healthz", headers={"X-Long": "a" * (LONGEST_HEAD - 1000)}).is_success

    @pytest.mark.parametrize(
        "start",
        [
            b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Long: ",
            b"GET /",
            CHUNKED + b"1;",
            CHUNKED + b"0\r\nX-Long: ",
        ],
        ids=["header", "address", "chunk extension", "trailer"],
    )
    def test_a_head_without_end_ends_the_connection(self, served, start):
        with socket.create_connection(address(served), timeout=HANG) as connection:
            connection.sendall(start)
            with pytest.raises((BrokenPipeError, ConnectionResetError)):
                connection.sendall(b"a" * (1000 * LONGEST_HEAD))


class TestDepth:
    """What follows long chains goes on; what stands deep in a form or a page's address is not a failure."""

    def test_a_chain_of_500_relations_is_explained_as_far_as_it_is_shown(self, http):
        parameters = {"p0": "11 mm", **{f"p{i}": f"= p{i - 1}" for i in range(1, 500)}}
        model = {"id": "moody", "parameters": {"size": "= p499"}}
        design = created(http, {"name": "chain", "parameters": parameters, "model": model})["id"]
        link = http.get(f"{API}/designs/{design}/explain/size", timeout=HANG).json()
        links = [link]
        while len(links) <= DEEPEST + 1 and (link := next(iter(link.get("because", ())), None)):
            links.append(link)
        assert [link["kind"] for link in links] == ["relation"] * DEEPEST + ["deeper"]
        assert links[-1]["value"]["unit"] == "mm"
        assert links[-1]["value"]["value"] == pytest.approx(11)
        page = http.get(f"/designs/{design}/explain/size", timeout=HANG)
        assert "depends on more values than are shown" in page.text

    def test_a_hundred_steps_of_one_long_name_have_a_sheet_each(self, http):
        double = {"template": "double", "inputs": {"length": {"value": [1, 2], "unit": "mm"}}}
        steps = {"a" * 60 + f"{i:03d}": double for i in range(100)}
        design = created(http, {"name": "alike", "steps": steps})["id"]
        answer = http.get(f"{API}/designs/{design}/worksheet.xlsx", timeout=HANG)
        assert len(load_workbook(BytesIO(answer.content)).sheetnames) == 101

    @pytest.mark.parametrize(
        ("path", "fields"),
        [
            ("/designs", {"template": "oil_film/" + "9" * 5000}),
            ("/designs", {"template": "a" * 70_000}),
            ("/designs", {"template": "a\nb?c#d"}),
            ("/designs", {"model": "a\nb/9"}),
            ("/designs/{design}/blocks", {"revision": "é\n", "add": "parameter", "name": "q", "value": "1"}),
            ("/designs/{design}/auto-map", {"revision": "é\n"}),
            ("/designs/{design}", {"revision": "1", "was": "{}", ".a": "[" * 100_000 + "]" * 100_000}),
        ],
    )
    def test_a_form_of_odd_text(self, http, any_design, path, fields):
        answer = http.post(path.format(design=any_design), data=fields, timeout=HANG)
        assert 303 <= answer.status_code < 500, answer.text[:500]

    @pytest.mark.parametrize(
        "path", ["/static/%00", "/designs/{design}/explain/%00", "/designs/{design}/explain/a%3Fb%0A"]
    )
    def test_an_address_of_odd_text(self, http, any_design, path):
        assert http.get(path.format(design=any_design), timeout=HANG).status_code == 404
