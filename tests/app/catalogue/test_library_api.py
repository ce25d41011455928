"""REST and the client return the library."""

import pytest
from serving import API, pages, problem


def test_list(http):
    listed = http.get(f"{API}/library").json()["items"]
    assert [item["id"] for item in listed] == ["bearing_material", "oil", "surface_finish"]
    assert list(pages(http, f"{API}/library", 2, 3)) == listed
    assert {item["id"] for item in listed if item["limits"]} == {"bearing_material"}


@pytest.mark.parametrize("id", ["bearing_material", "oil", "surface_finish"])
def test_every_value_of_a_table_has_a_source(http, id):
    table = http.get(f"{API}/library/{id}").json()
    columns = {column["name"]: column for column in table["columns"]}
    assert table["rows"]
    for row in table["rows"]:
        assert row["source"]
        assert row["values"].keys() <= columns.keys()
        for name, value in row["values"].items():
            assert value["unit"] == columns[name]["unit"]
            assert value["source"]


def test_a_column_names_the_inputs_that_it_fills(http):
    columns = http.get(f"{API}/library/surface_finish").json()["columns"]
    assert {c["name"]: c["fills"] for c in columns} == {
        "mean_roughness": [],
        "rms_roughness": ["journal_roughness", "bearing_roughness"],
    }


def test_unknown_table(http):
    answer = problem(http.get(f"{API}/library/steel"), 404, "unknown-table")
    assert "bearing_material" in answer["detail"]


def test_through_the_client(client):
    assert [table.id for table in client.library()] == ["bearing_material", "oil", "surface_finish"]
    bronze = next(row for row in client.library_table("bearing_material").rows if row.id == "tin_bronze")
    assert bronze.values["permissible_specific_load"].value == 30
    assert "Carvill" in bronze.values["permissible_specific_load"].source
