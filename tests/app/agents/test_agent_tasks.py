"""The bench of tasks for agents: its answers, its grades, and a client that follows the skill literally."""

import asyncio
import json
import math
from collections import Counter

import pytest
from mcp import Client
from mcp_clients import Tools, size

from benchmarks.agent_tasks import answers as bench
from benchmarks.agent_tasks.cases import CASES
from benchmarks.agent_tasks.grade import grade, graded
from benchmarks.agent_tasks.scripted import Script, submission

RIGHT = json.loads(bench.ANSWERS.read_text(encoding="utf-8"))
WORDS = {task["id"]: task["words"] for task in json.loads(bench.TASKS.read_text(encoding="utf-8"))}
CALCULATED = [id for id in RIGHT if id.split("-")[0] in ("number", "chain", "unit")]
MOST_BYTES = 2000


@pytest.fixture(scope="module")
def tools(served):
    return Tools(served.url)


def asked(tools, ask):
    """The answers of the script; every answer of a tool is short."""

    async def run():
        async with Client(tools.server.protocol()) as client:

            async def call(name, arguments):
                result = await client.call_tool(name, arguments)
                assert size(result) <= MOST_BYTES
                return result

            async def read(uri):
                return (await client.read_resource(uri)).contents[0].text

            return await ask(call, read)

    return asyncio.run(run())


def test_the_bench_has_the_tasks_that_it_states():
    counts = Counter(id.partition("-")[0] for id in RIGHT)
    assert counts == {"number": 10, "search": 10, "chain": 10, "unit": 10, "conflict": 20}
    assert list(WORDS) == list(RIGHT) == [case.id for case in CASES]


def test_the_words_are_those_of_the_cases():
    assert WORDS == {case.id: bench.words(case, place) for place, case in enumerate(CASES)}


@pytest.mark.parametrize("case", [case for case in CASES if case.search is None], ids=lambda case: case.id)
def test_a_right_number_is_calculated_again(case):
    assert bench.answer(case) == RIGHT[case.id]


@pytest.mark.sampled(6)
@pytest.mark.parametrize("case", [case for case in CASES if case.search], ids=lambda case: case.id)
def test_a_search_is_carried_out_again_at_every_level(case):
    assert bench.answer(case) == RIGHT[case.id]


def test_a_closed_form_agrees_with_the_template():
    for case in CASES:
        if case.exact:
            right = RIGHT[case.id]
            use = case.use
            if case.before:
                carried = bench.computed(*case.before[:2])
                use = use.changed(**{case.before[2]: f"{carried.value!r} {carried.unit}"})
            computed = bench.computed(use, case.wanted).value
            assert computed == pytest.approx(right["value"], rel=right["within"]), case.id


NUMBER = {"outcome": "answered", "value": 4.0, "unit": "um", "within": 1e-4, "verdict": "confirmed"}
CONFLICT = {"outcome": "infeasible", "names": ["load", "power_loss"]}


@pytest.mark.parametrize(
    ("given", "right", "expected"),
    [
        ({"outcome": "answered", "value": 4.0003, "unit": "um", "verdict": "confirmed"}, NUMBER, "right"),
        ({"outcome": "answered", "value": 0.0040003, "unit": "mm", "verdict": "confirmed"}, NUMBER, "right"),
        ({"outcome": "answered", "value": 4.1, "unit": "um", "verdict": "confirmed"}, NUMBER, "fatal"),
        ({"outcome": "answered", "value": 4.0, "unit": "mm", "verdict": "confirmed"}, NUMBER, "fatal"),
        ({"outcome": "answered", "value": 4.0, "unit": "kN", "verdict": "confirmed"}, NUMBER, "fatal"),
        ({"outcome": "answered", "value": 4.0, "verdict": "confirmed"}, NUMBER, "fatal"),
        ({"outcome": "answered", "value": math.nan, "unit": "um", "verdict": "confirmed"}, NUMBER, "fatal"),
        ({"outcome": "answered", "value": 4.1, "unit": "um", "verdict": "met"}, NUMBER, "wrong"),
        ({"outcome": "answered", "value": 4.0, "unit": "um", "verdict": "met"}, NUMBER, "wrong"),
        ({"outcome": "answered", "value": "4", "unit": "um", "verdict": "met"}, NUMBER, "wrong"),
        ({"outcome": "refused", "names": ["load"]}, NUMBER, "wrong"),
        ({}, NUMBER, "wrong"),
        (None, NUMBER, "wrong"),
        ({"outcome": "infeasible", "names": ["a.load >= 4 kN; a.power_loss <= 1 W"]}, CONFLICT, "right"),
        ({"outcome": "infeasible", "names": ["load"]}, CONFLICT, "wrong"),
        ({"outcome": "infeasible", "names": "load power_loss"}, CONFLICT, "wrong"),
        ({"outcome": "refused", "names": ["load", "power_loss"]}, CONFLICT, "wrong"),
        ({"outcome": "answered", "value": 1.0, "unit": "mm", "verdict": "confirmed"}, CONFLICT, "fatal"),
    ],
)
def test_the_grade_of_an_answer(given, right, expected):
    assert graded(given, right) == expected


def test_one_wrong_number_called_confirmed_fails_the_run():
    given = {id: dict(right) for id, right in RIGHT.items()}
    assert not grade(given, RIGHT).has_failed
    assert set(grade(given, RIGHT).grades.values()) == {"right"}
    given["number-01"]["value"] *= 1.01
    report = grade(given, RIGHT)
    assert report.has_failed
    assert report.lines()[-1] == "FAILED: confirmed, but wrong: number-01"


def test_the_script_calculates_and_refuses_as_the_skill_says(tools):
    """The tasks of one calculation, of two in a row, and with wrong units."""

    async def ask(call, read):
        script = Script(call, read)
        return {id: await script.answer(WORDS[id]) for id in CALCULATED}

    report = grade(asked(tools, ask), {id: RIGHT[id] for id in CALCULATED})
    assert [id for id, one in report.grades.items() if one != "right"] == []


@pytest.mark.slow
def test_the_script_solves_every_feasible_task_and_refuses_all_others(tools):
    report = grade(asked(tools, submission), RIGHT)
    assert [id for id, one in report.grades.items() if one != "right"] == []
