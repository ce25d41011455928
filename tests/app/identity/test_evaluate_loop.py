"""A loop of the Python client evaluates without end, as fast as the server answers."""

import pytest

from templates.door import built_in

COUNT = 10_000


@pytest.mark.slow
def test_ten_thousand_evaluations_in_a_loop_succeed(team):
    """The client waits for nothing (`patience=0`), so the first refusal would end the loop."""
    example = built_in().get("journal_friction", 1).example
    with team.client("viewer") as client:
        client.patience = 0
        first = client.evaluate("journal_friction", 1, example)
        for _ in range(COUNT - 1):
            assert client.evaluate("journal_friction", 1, example).outputs == first.outputs
