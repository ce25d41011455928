"""A model with two versions: which is the latest, and that a withdrawn one is built as before."""

import pytest
from two_versions import folder_of_two_versions

from cad.model import CadModel
from cad.regenerate import regenerate_class
from templates.core.catalogue.digests import digest
from templates.core.catalogue.finding import find


@pytest.fixture(scope="module")
def plates(tmp_path_factory):
    return find([folder_of_two_versions(tmp_path_factory.mktemp("team") / "plates")], CadModel)


def test_both_versions_stand_side_by_side_and_the_latest_is_not_withdrawn(plates):
    assert sorted(plates.of("plate")) == [1, 2]
    assert plates.latest("plate").version == 2
    assert plates.get("plate", 1).withdrawn == "too thin, use 2"
    assert digest(plates.get("plate", 1)) != digest(plates.get("plate", 2))


def test_a_withdrawn_version_is_built_as_before(plates):
    first, second = (regenerate_class(plates.get("plate", n), {"size": "20 mm"}) for n in (1, 2))
    assert first.measures["volume"] == pytest.approx(800, rel=1e-9)
    assert second.measures["volume"] == pytest.approx(1600, rel=1e-9)
