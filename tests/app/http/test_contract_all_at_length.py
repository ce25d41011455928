"""The checks of test_contract.py run on requests that cover each keyword of each schema."""

import pytest
from hypothesis import Phase, settings
from test_contract import QUICK, ask, interface


@pytest.mark.slow
@interface("coverage").parametrize()
@settings(QUICK, phases=[Phase.explicit])
def test_contract_all_keywords(served, case):
    ask(case, served.url)
