"""A model gives the positions of a throw's pin and fillets."""

import pytest

from cad.fillets import Crank
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft

SIZES = {"journal_diameter": 0.055, "journal_length": 0.04, "pin_diameter": 0.048, "pin_length": 0.032,
         "web_thickness": 0.018, "web_width": 0.08, "throw": 0.042, "fillet": 0.003}  # fmt: skip


def test_a_throw_says_its_plain_sizes():
    sizes = CrankThrow.from_si(SIZES).throw_sizes()
    assert sizes is not None
    assert vars(sizes) == pytest.approx(vars(Crank(42.0, 24.0, 32.0, 27.5, 18.0, 3.0)), rel=1e-12)
    assert sizes.plain == pytest.approx(26.0)


def test_a_shaft_with_ends_is_no_throw():
    assert CrankThrow.is_throw()
    assert not Crankshaft.is_throw()
    assert Crankshaft.from_quantities(Crankshaft.example).throw_sizes() is None
