"""The library's files have the required form, and their values agree with their sources."""

import pytest

from templates.core.criteria.criterion import read_criterion
from templates.core.criteria.limits import read_limits
from templates.core.errors import InvalidInputs
from templates.core.units.units import require_same_kind, unit
from templates.door import built_in
from templates.library.choices import CHOICES
from templates.library.csv_tables import Source, UnusableTable, read_rows, read_sources
from templates.library.tables import UnknownTable, fills, limits_of, table, tables
from templates.physics.journals.oil_grades import grades

HEAD = "id,words,load [MPa],heat [degC],source,source of heat,note,confirmed"
SOURCES = {
    "book": Source("A book, p. 1", "a copy; 2026-11"),
    "other": Source("Another book", "a copy; 2026-11"),
}
PSI = 6894.757293168  # Pa


def written(tmp_path, *lines):
    path = tmp_path / "table.csv"
    path.write_text("\n".join(("# a comment", *lines)) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("id", tables())
def test_every_value_has_a_source_and_the_unit_of_its_column(id):
    columns = {column.name: column for column in table(id).columns}
    for row in table(id).rows:
        assert row.words
        assert row.source
        assert row.values
        for name, cited in row.values.items():
            assert cited.source
            assert cited.value > 0
            assert require_same_kind(cited.unit, columns[name].unit) == unit(cited.unit)


def test_the_oils_are_those_of_oil_film():
    assert tuple(row.id for row in table("oil").rows) == grades()
    assert {"SAE 15W-40", "ISO VG 46"} <= {row.words for row in table("oil").rows}


@pytest.mark.parametrize(("row", "psi"), [("tin_babbitt_b23_1", 2650), ("tin_babbitt_b23_2", 3000),
                                          ("tin_babbitt_b23_3", 3150), ("lead_babbitt_b23_7", 1600),
                                          ("lead_babbitt_b23_8", 1750)])  # fmt: skip
def test_literature_the_yield_of_babbitt_in_both_units_of_its_standard(row, psi):
    """ASTM B23-00 prints psi and MPa, the latter to one place and off by 0.1 at times."""
    assert limits_of("bearing_material", row)["permissible_pressure"].value == pytest.approx(
        psi * PSI / 1e6, abs=0.1
    )


@pytest.mark.parametrize(("row", "psi_fpm"), [("tin_babbitt_b23_2", 30_000), ("lead_babbitt_b23_7", 18_000),
                                              ("manganese_bronze", 150_000), ("aluminium_bronze", 125_000),
                                              ("leaded_tin_bronze", 75_000)])  # fmt: skip
def test_literature_pressure_times_speed_in_both_units_of_its_source(row, psi_fpm):
    """Mott rounds the factor between psi·ft/min and Pa·m/s (35.03) to 35."""
    printed = limits_of("bearing_material", row)["permissible_pressure_times_speed"].value
    assert printed == pytest.approx(psi_fpm * 35e-6, rel=1e-12)
    assert printed == pytest.approx(psi_fpm * PSI * 0.3048 / 60 / 1e6, rel=1e-3)


def test_a_value_may_have_a_source_of_its_own():
    values = limits_of("bearing_material", "tin_babbitt_b23_2")
    assert "Carvill" in values["permissible_specific_load"].source
    assert "ASTM B23" in values["permissible_pressure"].source
    assert (values["permissible_specific_load"].value, values["permissible_specific_load"].unit) == (
        5.5,
        "MPa",
    )


def test_no_row_gives_what_its_source_does_not():
    assert "permissible_temperature" not in limits_of("bearing_material", "white_metal_thin_lining")
    assert set(limits_of("bearing_material", "aluminium_bronze")) == {"permissible_pressure_times_speed"}


def test_a_finish_is_a_root_mean_square_of_1_25_ra():
    rows = {row.id: cited.value for row, cited in fills("journal_roughness")}
    assert list(rows) == [f"n{grade}" for grade in range(2, 11)]
    assert rows["n4"] == pytest.approx(1.25 * 0.2)
    assert list(fills("radial_load")) == []


def test_unknown_names_are_refused_with_what_there_is():
    with pytest.raises(UnknownTable, match="bearing_material, oil, surface_finish"):
        table("steel")
    with pytest.raises(UnknownTable):
        limits_of("oil", "sae_30")  # gives inputs, no limits
    with pytest.raises(KeyError):
        limits_of("bearing_material", "tin_bronse")


def bearing_criteria():
    """Two criteria that take limits from a bearing material."""
    limits = {
        "permissible_specific_load": {"unit": "N/mm**2", "from": "bearing_material"},
        "permissible_temperature": {"unit": "K", "from": "bearing_material"},
    }
    loaded = {"require": "9 MPa <= permissible_specific_load"}
    heated = {"require": "350 K <= permissible_temperature"}
    pairs = zip((loaded, heated), limits.items(), strict=True)
    return [read_criterion("one", {**raw, "limits": {name: limit}}, {}) for raw, (name, limit) in pairs]


def test_a_row_fills_the_limits_for_which_it_has_a_value():
    given = read_limits(bearing_criteria(), {"bearing_material": "tin_bronze"})
    assert given["permissible_specific_load"].value == pytest.approx(30e6)
    assert given["permissible_temperature"].value == pytest.approx(533.15)
    assert "Carvill" in given["permissible_temperature"].source
    given = read_limits(bearing_criteria(), {"bearing_material": "white_metal_thin_lining"})
    assert {name: limit.value for name, limit in given.items()} == {"permissible_specific_load": 14e6}


def test_a_limit_given_by_hand_wins_over_a_row():
    raw = {"bearing_material": "tin_bronze", "permissible_specific_load": "12 MPa"}
    given = read_limits(bearing_criteria(), raw)
    assert given["permissible_specific_load"].value == pytest.approx(12e6)
    assert given["permissible_specific_load"].source is None
    assert given["permissible_temperature"].value == pytest.approx(533.15)


def test_an_unknown_row_is_refused_with_what_is_near():
    with pytest.raises(InvalidInputs) as refused:
        read_limits(bearing_criteria(), {"bearing_material": "tin_bronse"})
    assert [fault.name for fault in refused.value.faults] == ["limits.bearing_material"]
    assert "tin_bronze" in refused.value.faults[0].detail


def test_the_choices_are_the_tables_that_give_limits():
    assert set(CHOICES) == {one.id for one in tables().values() if one.limits}


def test_every_limit_that_a_template_takes_from_a_table_is_a_column_of_it():
    """Of the same kind of quantity, and given by some row."""
    taken = {
        (limit.library, limit.name, limit.unit)
        for cls in built_in()
        for criterion in cls.declared_criteria
        for limit in criterion.limits
        if limit.library
    }
    assert {name for _, name, _ in taken} == {
        "permissible_specific_load",
        "permissible_pressure",
        "permissible_temperature",
    }
    for library, name, declared in taken:
        column = next(column for column in table(library).columns if column.name == name)
        assert require_same_kind(column.unit, declared)
        assert any(name in row.values for row in table(library).rows)


def test_a_whole_table_is_read(tmp_path):
    path = written(tmp_path, HEAD, "tin,a metal,5.5,150,book,other,soft,yes", "lead,another,,90,book,,,yes")
    tin, lead = read_rows(path, SOURCES)
    assert (tin.values["load"].source, tin.values["heat"].source) == ("A book, p. 1", "Another book")
    assert (tin.note, lead.note) == ("soft", "")
    assert set(lead.values) == {"heat"}
    assert lead.values["heat"].source == "A book, p. 1"


@pytest.mark.parametrize(("line", "message"), [
    ("tin,a metal,5.5,150,book,,,no", "not confirmed"),
    ("tin,a metal,5.5,150,,,,yes", "not in the list of sources"),
    ("tin,a metal,5.5,150,book,rumour,,yes", "'rumour', which is not in the list"),
    ("tin,a metal,soft,150,book,,,yes", "'soft' is not a number"),
    ("tin,a metal,inf,150,book,,,yes", "'inf' is not a number"),
    ("tin,a metal,,,book,,,yes", "no value"),
    ("tin,,5.5,150,book,,,yes", "no description"),
    ("Tin 1,a metal,5.5,150,book,,,yes", "not a valid name"),
    ("tin,a metal,5.5,150,book,,,yes,more", "more cells"),
])  # fmt: skip
def test_a_row_that_is_not_whole_is_refused(tmp_path, line, message):
    with pytest.raises(UnusableTable, match=message):
        read_rows(written(tmp_path, HEAD, line), SOURCES)


def test_a_row_that_is_there_twice_is_refused(tmp_path):
    line = "tin,a metal,5.5,150,book,,,yes"
    with pytest.raises(UnusableTable, match="'tin' occurs 2 times"):
        read_rows(written(tmp_path, HEAD, line, line), SOURCES)


@pytest.mark.parametrize(("head", "message"), [
    (HEAD.replace("[MPa]", "[Mpsi/soft]"), "unit"),
    (HEAD.replace("load [MPa]", "load"), "write quantities like"),
])  # fmt: skip
def test_a_head_that_is_none_is_refused(tmp_path, head, message):
    with pytest.raises(UnusableTable, match=message):
        read_rows(written(tmp_path, head, "tin,a metal,5.5,150,book,,,yes"), SOURCES)


@pytest.mark.parametrize("line", ["book,,a copy", "book,A book,"])
def test_a_source_that_nobody_read_is_refused(tmp_path, line):
    with pytest.raises(UnusableTable, match="no citation, or is not marked as read"):
        read_sources(written(tmp_path, "key,citation,read", line))
