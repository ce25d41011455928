"""Every stored file is sent whole, in ranges, or not at all to a client that has it."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "worksheet_import"))  # mathcad_files

from stored_routes import ROUTES, check_conditions, path_of


@pytest.mark.sampled(2)
@pytest.mark.parametrize("route", ROUTES)
def test_conditions_of_a_file_in_a_folder(http, route):
    check_conditions(http, path_of(http, route))
