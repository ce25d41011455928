"""The page on metrics lists exactly the metrics of `/metrics`, with their types."""

import re
from pathlib import Path

from prometheus_client.parser import text_string_to_metric_families

from app.observation import metrics
from app.settings import Settings

PAGE = Path(__file__).parents[3] / "docs" / "operating" / "metrics.md"
ROW = re.compile(r"^\| `(\w+)` \| (\w+) \| ([^|]+) \|([^|]*)\| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)


def listed():
    """Name → type of the rows, each of which has a unit, a meaning and advice."""
    rows = ROW.findall(PAGE.read_text())
    assert len({row[0] for row in rows}) == len(rows)
    assert all(cell.strip() for row in rows for cell in (*row[:3], *row[4:]))
    return {name: kind for name, kind, *_ in rows}


def given():
    """Name → type of what is answered; the library reads a counter's name without `_total`."""
    metrics.committed(1, 0.1, True)
    families = text_string_to_metric_families(metrics.text([("build", "queued", 1)], 0.0).decode())
    return {
        f"{family.name}_total" if family.type == "counter" else family.name: family.type
        for family in families
        if not family.name.endswith("_created")
    }


def test_the_page_lists_all_metrics_and_no_others():
    assert listed() == given()


def test_labels_are_those_of_the_metrics():
    rows = {row[0]: set(re.findall(r"`(\w+)`", row[3])) for row in ROW.findall(PAGE.read_text())}
    metrics.bucket_asked("get", "done", 0.1)
    families = {
        f"{one.name}_total" if one.type == "counter" else one.name: one
        for one in text_string_to_metric_families(metrics.text([("build", "queued", 1)], 0.0).decode())
    }
    for name, labels in rows.items():
        for sample in families[name].samples:
            assert {*sample.labels} - {"le"} == labels, name


def test_settings_that_the_page_names_are_there():
    named = set(re.findall(r"CRANKWRIGHT_(\w+)", PAGE.read_text()))
    assert named <= {name.upper() for name in Settings.model_fields}
