"""Keys of requests that may be sent again are kept for a week."""

from datetime import UTC, datetime, timedelta

from app.idempotency import Once, forget_old_keys
from app.storage.identity import as_text
from app.storage.tables import IdempotencyRow


def test_keys_older_than_a_week_are_forgotten(database):
    def aged(session):
        for key, days in (("old", 8), ("young", 6)):
            Once(key, "POST /designs", "body").keep(session, 201, {"id": key})
            session.flush()
            row = session.get(IdempotencyRow, (key, "POST /designs", ""))
            row.created = as_text(datetime.now(UTC) - timedelta(days=days))

    database.write(aged)
    database.write(forget_old_keys)
    with database.read() as session:
        assert Once("old", "POST /designs", "body").find(session) is None
        assert Once("young", "POST /designs", "body").find(session) == {"id": "young"}
