"""An idempotency key belongs to the client that sent it, and to the same request."""

from serving import API, moody, problem

from app.storage.idempotency import Once

SCOPE = "POST /designs"
ANNA, BEN = "name:anna", "name:ben"


def kept(database, once, **location):
    database.write(lambda session: once.keep(session, 201, location))


def looked_up(database, once):
    with database.read() as session:
        return once.find(session)


def test_two_clients_may_choose_the_same_key(database):
    anna, ben = (Once("key", SCOPE, f"body of {client}", client) for client in (ANNA, BEN))
    kept(database, anna, id="anna's")
    assert looked_up(database, ben) is None
    kept(database, ben, id="ben's")
    assert [looked_up(database, once)["id"] for once in (anna, ben)] == ["anna's", "ben's"]


def test_no_key_finds_nothing(database):
    once = Once(None, SCOPE, "body", ANNA)
    kept(database, once, id="not kept")
    assert looked_up(database, once) is None


class TestOverHttp:
    def post(self, http, client, key="same-key", **more):
        headers = {"Crankwright-Client": client, "Idempotency-Key": key, "Prefer": "wait=60"}
        return http.post(f"{API}/designs", json=moody("33 mm", **more), headers=headers)

    def test_two_clients_make_two_designs(self, http):
        anna, ben = self.post(http, "anna"), self.post(http, "ben")
        assert (anna.status_code, ben.status_code) == (201, 201)
        assert anna.json()["id"] != ben.json()["id"]
        again = self.post(http, "anna")
        assert again.json()["id"] == anna.json()["id"]
        problem(self.post(http, "anna", name="another"), 422, "idempotency-key-reused")
