"""The service returns the network of relations in a design over HTTP."""

from serving import API, created, paper, problem

from templates.core.units.units import compatible, dimension_of, unit

DESIGNS = f"{API}/designs"


def network(http, document):
    design = created(http, document)
    answer = http.get(f"{DESIGNS}/{design['id']}/network")
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_blocks_stand_behind_what_drives_them(http):
    answer = network(http, paper(name="network"))
    columns = {block["name"]: block["column"] for block in answer["blocks"]}
    assert columns["film"] < columns["model"]
    relations = {one["target"]: one for one in answer["relations"]}
    bore = relations["model.inner_diameter"]
    assert (bore["source"], bore["forward"]) == ("film.bearing_diameter", True)
    for one in answer["relations"]:
        ends = [columns[one[end].partition(".")[0]] for end in ("source", "target")]
        assert one["forward"] == (ends[0] < ends[1])


def test_every_name_is_one_that_a_relation_may_use(http):
    names = {one["name"]: one for one in network(http, paper(name="names"))["names"]}
    assert names["film.minimum_film_thickness"]["role"] == "output"
    assert names["model.mass"] == {
        "name": "model.mass",
        "role": "measure",
        "words": "mass, measured",
        "unit": "kg",
        "dimension": "mass^1",
    }
    assert names["film.bearing_diameter"]["dimension"] == names["model.inner_diameter"]["dimension"]
    assert names["scale"] == {
        "name": "scale",
        "role": "parameter",
        "words": "parameter of the design",
        "unit": "1",
        "dimension": "1",
    }
    design = http.get(DESIGNS, params={"name": "names"}).json()["items"][0]["id"]
    patch = {"parameters": {f"probe_{at}": f"= {name}" for at, name in enumerate(names)}}
    answer = http.post(f"{DESIGNS}/{design}/preview", json=patch, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text


def test_an_input_of_a_later_block_drives_backward(http):
    sizes = {"inner_diameter": "48 mm", "width": "20 mm", "wall": "3 mm"}
    shell = {"id": "plain_bearing", "version": 1}
    document = {
        "name": "backward",
        "models": {
            "one": {**shell, "parameters": {**sizes, "inner_diameter": "= two.inner_diameter"}},
            "two": {**shell, "parameters": {**sizes, "width": "= 1 mm + one.high_x"}},
        },
    }
    answer = network(http, document)
    columns = {block["name"]: block["column"] for block in answer["blocks"]}
    assert columns == {"one": 0, "two": 1}
    assert {one["target"]: one["forward"] for one in answer["relations"]} == {
        "one.inner_diameter": False,
        "two.width": True,
    }


def test_a_design_that_is_not_there(http):
    problem(http.get(f"{DESIGNS}/none/network"), 404, "not-found")


def test_dimensions_are_equal_where_units_are_compatible():
    texts = ("mm", "inch", "1", "rpm", "1/s", "Hz", "N*m", "N*m/rad", "J", "degC", "K", "deg", "MPa", "um")
    units = [unit(text) for text in texts]
    for one in units:
        for other in units:
            either = unit("1/s") in (one, other) and compatible(one, other)  # rad/s or Hz
            assert (dimension_of(one) == dimension_of(other) or either) == compatible(one, other)


def test_a_parameter_of_a_compound_unit(http):
    document = {**paper(name="compound"), "parameters": {"scale": "1", "load": "25 kN", "push": "3 N*m"}}
    names = {one["name"]: one for one in network(http, document)["names"]}
    assert unit(names["load"]["unit"]).base == unit("N").base
    assert names["push"]["dimension"] == dimension_of(unit("N*m"))
