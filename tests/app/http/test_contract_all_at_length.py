"""The promises of test_contract.py, on what covers each keyword of each schema; all that can be asked so."""

import pytest
from hypothesis import Phase, settings
from test_contract import QUICK, ask, interface


@pytest.mark.slow
@interface("coverage").parametrize()
@settings(QUICK, phases=[Phase.explicit])
def test_contract_all_keywords(served, case):
    ask(case, served.url)
