"""A client that follows the skill to the letter: it reads the words of a task, and understands nothing else.

    python -m benchmarks.agent_tasks.scripted --url http://127.0.0.1:8000 > submission.json

It shows that the tools and the skill suffice: every number of a submission comes from a tool, and what a tool
refuses is refused. It finds quantities in the words of a task by the names that `explain` lists.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import sys
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

TASKS = Path(__file__).with_name("tasks.json")
Submission = dict[str, dict[str, object]]
Call = Callable[[str, dict[str, Any]], Awaitable[Any]]
Read = Callable[[str], Awaitable[str]]

TAKEN = re.compile(r"(?:Take|First,|Then,) (.+?)(?:, with its (.+?) as the (.+?))?: (.+?)\.(?= [A-Z])")
WANTED = re.compile(r"What is the (.+)\?$")
SEARCH = re.compile(
    r"Find the (.+?) between (\S+ \S+) and (\S+ \S+) in steps of (\S+ \S+) "
    r"that gives the (least|greatest) (.+?) while (.+)\.$"
)
NEED = re.compile(r"the (.+?) is at (least|most) (.+)")
SMALL = {"a", "an", "the", "of", "in", "its", "on", "with"}


class Refusal(Exception):
    """What a tool refuses, or the words do not say; `names` are the quantities that are wrong."""

    def __init__(self, names: Sequence[str]) -> None:
        super().__init__(", ".join(names))
        self.names = list(names)


@dataclass(frozen=True)
class Subject:
    """A template with the names of its inputs, limits and outputs by their words."""

    id: str
    version: int
    names: Mapping[str, Mapping[str, str]]  # group: words: name

    def name(self, group: str, words: str) -> str:
        """Return the name of an input or output that the words name."""
        return self.names[group][words]


@dataclass(frozen=True)
class Script:
    """The script, with the tools that it calls."""

    call: Call
    read: Read

    async def answer(self, words: str) -> dict[str, object]:
        """Return the answer to a task."""
        try:
            return await self._answer(words)
        except Refusal as refusal:
            return {"outcome": "refused", "names": refusal.names}

    async def _answer(self, words: str) -> dict[str, object]:
        carried: dict[str, str] = {}
        parts = TAKEN.findall(words)
        for place, (subject, output, name, givens) in enumerate(parts):
            use = await self.find(subject)
            values = self.values(use, givens)
            if output:
                values["inputs"][use.name("inputs", name)] = carried[output]
            if place + 1 < len(parts):
                wanted = parts[place + 1][1]
                number = await self.number(use, values, wanted)
                carried[wanted] = f"{number['value']} {number['unit']}"
        if found := SEARCH.search(words):
            return await self.search(use, values["inputs"], found.groups())
        found = WANTED.search(words)
        assert found is not None, words
        number = await self.number(use, values, found[1])
        return {"outcome": "answered", **_shown(number)}

    async def find(self, subject: str) -> Subject:
        """Find the template of a subject, and read its names."""
        words = " ".join(re.findall(r"\w+", subject))
        sought = [word for word in words.split() if word.lower() not in SMALL]
        listed = await self.called("find", {"words": " ".join(sought), "kind": "template"})
        _, id, version = listed["items"][0]["name"].split()
        explained = await self.called("explain", {"id": id, "version": int(version)})
        names: dict[str, dict[str, str]] = {"inputs": {}, "limits": {}, "outputs": {}}
        for item in json.loads(await self.read(explained["rest"]))["items"]:
            group, _, name = item["name"].partition(" ")
            group = "inputs" if group == "required" else group
            if group in names:
                title = item["text"].partition(" [")[0]
                names[group] |= {name.replace("_", " "): name, title: name}
        return Subject(id, int(version), names)

    def values(self, use: Subject, givens: str) -> dict[str, dict[str, str]]:
        """Return the inputs and limits that the words state, as they state them."""
        values: dict[str, dict[str, str]] = {"inputs": {}, "limits": {}}
        for given in givens.split("; "):
            group, words = self._named(use, given)
            values[group][use.name(group, words)] = given[len(words) :].strip()
        return values

    def _named(self, use: Subject, given: str) -> tuple[str, str]:
        """Return the longest words of an input or limit with which a given begins."""
        fits = [
            (group, words)
            for group in ("inputs", "limits")
            for words in use.names[group]
            if given.startswith(f"{words} ")
        ]
        if not fits:
            raise Refusal([given])
        return max(fits, key=lambda fit: len(fit[1]))

    async def number(self, use: Subject, values: Mapping[str, object], wanted: str) -> Mapping[str, Any]:
        """Return the wanted number, as the tool shows it."""
        output = use.name("outputs", wanted)
        arguments = {"template": use.id, "version": use.version, "outputs": [output], **values}
        answer = await self.called("evaluate", arguments)
        return next(number for number in answer["numbers"] if number["name"] == output)

    async def search(self, use: Subject, inputs: dict[str, str], words: Sequence[str]) -> dict[str, object]:
        """Answer which value of an input meets the requirements best."""
        free, lower, upper, step, sense, objective, needs = words
        place = f"a.{use.name('inputs', free)}"
        step_of_design = {"template": use.id, "version": use.version, "inputs": inputs}
        arguments = {
            "design": {"name": "task", "steps": {"a": step_of_design}},
            "free": {place: {"between": [lower, upper], "step": step}},
            "require": [self._required(use, need) for need in needs.split(" and ")],
            "minimise" if sense == "least" else "maximise": f"a.{use.name('outputs', objective)}",
        }
        answer = await self.called("answer", arguments)
        numbers = {number["name"]: number for number in answer["numbers"]}
        if answer["summary"].startswith("infeasible"):
            items = {item["name"]: item["text"] for item in answer["items"]}
            return {"outcome": "infeasible", "names": items["conflict"].split("; ")}
        return {"outcome": "answered", **_shown(numbers[place])}

    def _required(self, use: Subject, need: str) -> str:
        found = NEED.fullmatch(need)
        assert found is not None, need
        sign = ">=" if found[2] == "least" else "<="
        return f"a.{use.name('outputs', found[1])} {sign} {found[3]}"

    async def called(self, tool: str, arguments: dict[str, Any]) -> Any:
        """Return the answer of a tool; what it refuses is refused."""
        result = await self.call(tool, arguments)
        if result.is_error:
            lines = result.content[0].text.splitlines()[1:-1]
            raise Refusal([line.partition(":")[0] for line in lines])
        return result.structured_content


def _shown(number: Mapping[str, Any]) -> dict[str, object]:
    verdict = number["verdict"].partition(" (")[0]
    return {"value": number["value"], "unit": number["unit"], "verdict": verdict}


async def submission(call: Call, read: Read) -> Submission:
    """Return the answers to all tasks."""
    script = Script(call, read)
    return {task["id"]: await script.answer(task["words"]) for task in json.loads(TASKS.read_text())}


async def over_stdio(url: str) -> Submission:
    """Return the answers to all tasks by `crankwright mcp`."""
    server = StdioServerParameters(
        command=sys.executable, args=["-m", "app", "mcp"], env={"CRANKWRIGHT_URL": url}
    )
    async with Client(stdio_client(server)) as client:

        async def read(uri: str) -> str:
            return str(getattr((await client.read_resource(uri)).contents[0], "text"))  # noqa: B009

        return await submission(client.call_tool, read)


def main() -> None:
    """Print the submission."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    print(json.dumps(asyncio.run(over_stdio(parser.parse_args().url)), indent=1))


if __name__ == "__main__":
    main()
