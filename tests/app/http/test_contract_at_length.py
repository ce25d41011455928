"""The checks of test_contract.py run on many more requests."""

import pytest
from hypothesis import seed, settings
from test_contract import INTERFACE, QUICK, SEED, ask


@pytest.mark.slow
@INTERFACE.parametrize()
@seed(SEED)
@settings(QUICK, max_examples=150)
def test_contract_at_length(served, case):
    ask(case, served.url)
