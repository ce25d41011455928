"""A stream of events ends when the key that opened it is revoked."""

from serving import API, created, heard, patched


def test_a_stream_ends_before_the_first_event_after_its_key_was_revoked(team):
    key = team.identity.add_key(team.principals["viewer"])[0]
    headers = {"Authorization": f"Bearer {key.text}"}
    with team.http("author") as author, team.http(headers=headers) as listener:
        design = created(author, {"name": "watched", "parameters": {"scale": "1"}})
        with listener.stream("GET", f"{API}/designs/{design['id']}/events") as stream:
            events = heard(stream)
            assert next(events)[0] == "current"
            team.identity.revoke(key.prefix)
            patched(author, design, {"parameters": {"scale": "2"}})
            assert list(events) == []
