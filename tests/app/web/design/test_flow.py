"""The layout of the relation network: boxes do not overlap, wires run forwards and behind no box."""

from itertools import combinations, pairwise
from random import Random

import pytest

from app.designs.schemas.network import DesignNetwork, NetworkBlock, NetworkRelation
from app.web.design.flow import drawing


def network(count, seed, backward=0):
    """A random network of steps in which later ones use values of earlier ones."""
    random = Random(seed)
    columns, relations = {}, []
    for at in range(count):
        target = f"step_{at}"
        sources = random.sample(sorted(columns), min(len(columns), random.randrange(4)))
        columns[target] = max((columns[source] + 1 for source in sources), default=0)
        for place, source in enumerate(sources):
            name = f"{source}.output_{random.randrange(3)}"
            relations.append(relation(f"{target}.input_{place}", name, forward=True))
    late, early = max(columns, key=columns.get), min(columns, key=columns.get)
    relations += [relation(f"{early}.assumed_{n}", f"{late}.mass", forward=False) for n in range(backward)]
    blocks = [NetworkBlock(name=name, kind="step", column=column) for name, column in columns.items()]
    return DesignNetwork(blocks=blocks, relations=relations, names=[], table=[])


def relation(target, source, forward):
    return NetworkRelation(
        target=target, source=source, relation=f"= {source} * 1.05 + 2 mm", forward=forward
    )


def are_apart(one, other):
    return (
        one.right <= other.x
        or other.right <= one.x
        or one.y + one.height <= other.y
        or other.y + other.height <= one.y
    )


@pytest.mark.parametrize("seed", range(20))
def test_boxes_are_apart_and_wires_go_forward_between_them(seed):
    given = network(12, seed, backward=seed % 3)
    picture = drawing(given)
    assert {box.name for box in picture.boxes} == {f"step_{at}" for at in range(12)}
    assert all(are_apart(one, other) for one, other in combinations(picture.boxes, 2))
    assert all(0 <= box.x and box.right <= picture.width for box in picture.boxes)
    assert all(0 <= box.y and box.y + box.height <= picture.height for box in picture.boxes)
    assert [wire.relation for wire in picture.wires] == given.relations
    for wire in picture.wires:
        if wire.relation.forward:
            assert all(x < to_x for (x, _), (to_x, _) in pairwise(wire.points))
            for (x, y), (to_x, _) in list(pairwise(wire.points))[1::2]:  # straight through a column
                crossed = (box for box in picture.boxes if box.x < to_x and box.right > x)
                assert all(y < box.y or y > box.y + box.height for box in crossed)


def test_wires_between_columns_meet_no_box():
    picture = drawing(network(12, 4))
    for wire in picture.wires:
        for (x, _), (to_x, _) in list(pairwise(wire.points))[::2]:
            assert not any(box.x < to_x and box.right > x for box in picture.boxes)


def test_parameters_are_drawn_where_they_take_part():
    blocks = [
        NetworkBlock(name="scale", kind="parameter", column=0),
        NetworkBlock(name="unused", kind="parameter", column=0),
        NetworkBlock(name="twice", kind="parameter", column=1),
        NetworkBlock(name="film", kind="step", column=2),
    ]
    relations = [relation("twice", "scale", True), relation("film.load", "twice", True)]
    picture = drawing(DesignNetwork(blocks=blocks, relations=relations, names=[], table=[]))
    assert {box.name: box.link for box in picture.boxes} == {
        "scale": "#-scale",
        "twice": "#-twice",
        "film": "#step-film",
    }


def test_long_relations_are_cut_in_rows_and_whole_in_titles():
    blocks = [NetworkBlock(name=name, kind="step", column=at) for at, name in enumerate(("a", "b"))]
    long = NetworkRelation(target="b.x", source="a.y", relation="= " + "a.y + " * 100 + "1", forward=True)
    picture = drawing(DesignNetwork(blocks=blocks, relations=[long], names=[], table=[]))
    row = picture.boxes[1].inputs["b.x"]
    assert len(row.text) <= 40
    assert row.title == f"b.x {long.relation}"
    assert picture.boxes[1].width < 320


def test_nothing_is_drawn_where_nothing_drives_anything():
    assert drawing(DesignNetwork(blocks=[], relations=[], names=[], table=[])) is None
