"""Events between servers of one PostgreSQL: all of them, in order, even if connections are lost."""

import asyncio
import json
import random
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from listening import NEVER, designs, followed, side
from patience import until
from sqlalchemy import text

from app.jobs.events import Event, events_above, note_events
from app.storage.database import Database

pytest.importorskip("psycopg", reason="the driver of PostgreSQL is not installed")
from app.storage.notices import MOST_BYTES, Notices, hints_of, payloads

WRITER = """
import sys
sys.path.append(sys.argv[1])
from listening import side
from app.jobs.events import Event, newest_numbers
from app.storage.database import repeatable
from app.storage.errors import StorageError

url, topic = sys.argv[2:]
with side(url) as own:
    for line in sys.stdin:
        first, last = map(int, line.split())
        for n in range(first, last):

            def unit(session):
                repeatable(session)
                if newest_numbers(session, [topic])[topic] == n:
                    own.events.note(session, Event(topic, "revision", {"revision": n}))

            while True:
                try:
                    own.database.write(unit)
                    break
                except StorageError:
                    pass
"""
BATCH, BATCHES = 30, 10
"""Events that the other process writes at a stretch, while all connections are ended, and how often."""


def terminated(cluster, url):
    """End all connections to a database; how many there were."""
    import psycopg

    name = url.rpartition("/")[2]
    with psycopg.connect(cluster.url().replace("+psycopg", ""), autocommit=True) as connection:
        ended = connection.execute(
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = %s", [name]
        )
        return len(ended.fetchall())


@pytest.mark.slow
def test_all_events_of_another_process_come_in_order_while_connections_are_ended(
    cluster, own_postgres, request
):
    with side(own_postgres, poll=1.0) as here:
        (topic,) = designs(here, "1")
        command = [sys.executable, "-c", WRITER, str(request.path.parent), own_postgres, topic]
        counts = []
        with subprocess.Popen(command, stdin=subprocess.PIPE, text=True) as writer:

            def next_batch(received):
                done = len(received)
                if done % BATCH == 0 and done < BATCH * BATCHES:
                    writer.stdin.write(f"{done} {done + BATCH}\n")
                    writer.stdin.flush()
                if done % BATCH == BATCH // 3:  # while it writes the rest
                    counts.append(terminated(cluster, own_postgres))

            next_batch([])
            received = asyncio.run(followed(here, topic, BATCH * BATCHES, next_batch))
            writer.stdin.close()
            assert writer.wait(60) == 0
    assert [event.number for event in received] == list(range(1, BATCH * BATCHES + 1))
    assert [event.data["revision"] for event in received] == list(range(BATCH * BATCHES))
    assert sum(counts) >= 4 * BATCHES, "connections of both sides were ended"


@pytest.mark.slow
def test_eight_writers_of_two_servers_miss_nothing(own_postgres):
    each, topics = 15, [f"design:{n}" for n in range(3)]

    def write(own, writer):
        order = random.Random(writer).sample(topics * each, 3 * each)
        for n, topic in enumerate(order):
            own.note(topic, "revision", writer=writer, n=n)

    async def scene(writing, reader):
        with ThreadPoolExecutor(8) as pool:
            written = [pool.submit(write, writing[writer % 2], writer) for writer in range(8)]
            heard = await asyncio.gather(*(followed(reader, topic, 8 * each) for topic in topics))
            await asyncio.gather(*map(asyncio.wrap_future, written))
        return heard

    with side(own_postgres) as one, side(own_postgres) as other, side(own_postgres, poll=1.0) as reader:
        designs(one, "0", "1", "2")
        heard = asyncio.run(scene((one, other), reader))
    for events in heard:
        assert [event.number for event in events] == list(range(1, 8 * each + 1))
        for writer in range(8):
            own = [event.data["n"] for event in events if event.data["writer"] == writer]
            assert own == sorted(own)
    everything = {(event.data["writer"], event.data["n"]) for events in heard for event in events}
    assert everything == {(writer, n) for writer in range(8) for n in range(3 * each)}


def test_a_hint_is_enough(own_postgres):
    async def scene(here, there, topic):
        async with here.events.subscribe(topic) as subscription:
            subscription.number = 0
            there.note(topic, "revision", "current")
            reader = aiter(subscription)
            async with asyncio.timeout(60):
                return [(await anext(reader)).name for _ in range(2)]

    with side(own_postgres) as here, side(own_postgres) as there:
        (topic,) = designs(here, "1")
        listening(own_postgres, 2)
        assert asyncio.run(scene(here, there, topic)) == ["revision", "current"]


@pytest.mark.slow
def test_a_lost_hint_costs_no_more_than_the_poll(own_postgres):
    async def scene(here, there, topic):
        async with here.events.subscribe(topic) as subscription:
            subscription.number = 0
            there.note(topic, "revision")
            async with asyncio.timeout(60):
                return (await anext(aiter(subscription))).name

    with side(own_postgres, poll=0.3) as here, side(own_postgres) as there:
        (topic,) = designs(here, "1")
        there.events.tell = list  # nobody hears it
        assert asyncio.run(scene(here, there, topic)) == "revision"


def listening(url, servers):
    """Wait until so many servers listen."""
    database = Database(url)
    query = text(
        "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND query ~ '^LISTEN'"
    )

    def count():
        with database.read() as session:
            return session.scalar(query)

    until(count, lambda number: number >= servers)
    database.close()


def test_numbers_of_a_topic_are_its_own_even_if_units_wait_for_each_other(own_postgres):
    """The second unit takes its number after the first one's commit, however early it began."""
    with side(own_postgres) as one, side(own_postgres) as other:
        (topic,) = designs(one, "1")
        began, go_on = threading.Event(), threading.Event()

        def slow(session):
            (noted,) = note_events(session, Event(topic, "slow", {}))
            began.set()
            assert go_on.wait(60)
            return noted.number

        with ThreadPoolExecutor(2) as pool:
            first = pool.submit(one.database.write, slow)
            assert began.wait(60)
            second = pool.submit(
                other.database.write,
                lambda session: note_events(session, Event(topic, "quick", {}))[0].number,
            )
            with other.database.read() as session:
                assert events_above(session, topic, 0) == []
            go_on.set()
            assert (first.result(60), second.result(60)) == (1, 2)


class TestPayloads:
    def test_hints_are_sent_in_as_few_notifications_as_hold_them(self):
        hints = [f"design:{number:024x}" for number in range(1000)]
        sent = list(payloads(hints))
        assert [hint for payload in sent for hint in hints_of(payload)] == hints
        assert all(len(payload.encode()) <= MOST_BYTES for payload in sent)
        assert len(sent) == -(-len(json.dumps(hints)) // MOST_BYTES)

    def test_none_are_no_notification(self):
        assert list(payloads([])) == []

    def test_what_others_send_on_the_channel_is_no_hint(self):
        assert [hints_of(payload) for payload in ("", "{", "1", '{"a": 1}', '[1, "queue:a"]')] == [
            [], [], [], [], ["queue:a"],
        ]  # fmt: skip


@pytest.mark.slow
def test_hints_that_reach_no_database_are_logged_and_end_nothing(caplog):
    notices = Notices("postgresql://nobody@127.0.0.1:1/nothing", NEVER, print)  # nothing listens on port 1
    notices.send(["queue:regenerate"])
    notices.stop()
    notices._send()  # in this thread, until it meets the end
    assert "hints to other servers are lost; they will poll the database" in caplog.text


def test_many_hints_arrive_though_one_notification_has_no_room_for_them(own_postgres):
    heard, complete = [], threading.Event()
    hints = [f"design:{number:024x}" for number in range(2000)]

    def hear(given):
        heard.extend(given or ())
        if len(heard) == len(hints):
            complete.set()

    there, here = Notices(own_postgres, NEVER, lambda given: None), Notices(own_postgres, NEVER, hear)
    for one in (here, there):
        one.start()
    listening(own_postgres, 2)
    there.send(hints)
    assert complete.wait(60)
    for one in (here, there):
        one.stop()
    assert heard == hints


def test_a_server_does_not_hear_itself(own_postgres):
    heard, back = [], threading.Event()

    def hear(hints):
        heard.extend(hints or ())
        if "back" in heard:
            back.set()

    here = Notices(own_postgres, NEVER, hear)
    there = Notices(own_postgres, NEVER, lambda hints: there.send(["back"]) if hints else None)
    for one in (here, there):
        one.start()
    listening(own_postgres, 2)
    here.send(["own"])
    assert back.wait(60)
    for one in (here, there):
        one.stop()
    assert heard == ["back"]
