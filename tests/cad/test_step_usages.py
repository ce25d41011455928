"""A STEP file does not depend on the counter of assembly usages, which never restarts in a process."""

import re

import pytest

from cad import step
from cad.catalogue import models
from cad.regenerate import regenerate


def wrapped(text):
    """A usage as the kernel's writer breaks it: tokens, commas among them, into lines of 72 characters."""
    lines = [""]
    for token in re.findall(r"#\d+ = \w+\(|'[^']*'|[^',)]+|,|\);", text):
        if len(lines[-1]) + len(token) > 72:
            lines.append("  ")
        lines[-1] += token
    return "\n".join(lines)


USAGE = re.compile(r"#\d+ = NEXT_ASSEMBLY_USAGE_OCCURRENCE\([^;]*;")


def built():
    cls = models().get("plain_bearing", 1)
    return regenerate(cls.id, cls.version, cls.from_quantities(cls.example).inputs_si()).step


@pytest.mark.sampled(2)
@pytest.mark.parametrize("digits", ["9", "57", "999", "12345678"])
def test_a_counter_that_has_run_on_leaves_no_trace(digits, monkeypatch):
    fresh, finished = built(), step.finished

    def later(usage):
        return wrapped(re.sub(r"\('\d+'", f"('{digits}'", usage[0].replace("\n  ", "")))

    def run_on(text, *rest, **more):
        usages = USAGE.findall(text)
        assert len(usages) == 2
        assert all(wrapped(one.replace("\n  ", "")) == one for one in usages), "the writer's rule"
        return finished(USAGE.sub(later, text), *rest, **more)

    monkeypatch.setattr(step, "finished", run_on)
    assert built() == fresh
