"""Events reach all subscribers in order, without duplicates or gaps, and never delay the sender."""

import asyncio
import random
import threading
from contextlib import asynccontextmanager
from itertools import islice

import pytest
from sqlalchemy import delete, func, select

from app.jobs.events import (
    _ROOM,
    PAGE,
    Event,
    Events,
    are_events_kept,
    events_above,
    newest_numbers,
    note_events,
)
from app.storage.clock import now
from app.storage.tables import DesignRow, EventRow, JobRow

TOPIC = "design:1"
DEADLINE = 30.0  # for what hangs [s]


class Undone(Exception):
    """Undoes a unit of work."""


@pytest.fixture
def events(database):
    """Events of a database with a design and a job of it."""
    database.write(lambda session: session.add(design("1")))
    return Events(database)


def design(id):
    return DesignRow(id=id, name="x", created=now(), head=0)


def job(id):
    return JobRow(
        id=id, kind="k", state="queued", payload={}, attempt=0, crashes=0, progress=0.0, log=[],
        created=now(), updated=now(),
    )  # fmt: skip


def noted(database, events, *names, topic=TOPIC):
    """Write events in a unit of their own."""
    news = [Event(topic, name, {"revision": 1}) for name in names]
    database.write(lambda session: events.note(session, *news))


def progress(text, topic=TOPIC):
    return Event(topic, "progress", {"text": text})


async def heard(subscription, count):
    """The next events of a subscription."""
    reader = aiter(subscription)
    async with asyncio.timeout(DEADLINE):
        return [await anext(reader) for _ in range(count)]


async def turns():
    """Let the loop hand over what was sent."""
    await asyncio.sleep(0)


@asynccontextmanager
async def following(events, number=0, topic=TOPIC):
    async with events.subscribe(topic) as subscription:
        subscription.number = number
        yield subscription


def numbers(events):
    return [event.number for event in events]


class TestRows:
    def test_topics_are_numbered_apart_without_a_gap(self, database, events):
        database.write(lambda session: session.add(job("2")))
        own, of_design = "job:2", TOPIC
        noted(database, events, "revision", "regenerating")
        database.write(
            lambda session: events.note(session, *(Event(topic, "running", {}) for topic in (own, of_design)))
        )
        noted(database, events, "done", topic=own)
        with database.read() as session:
            assert numbers(events_above(session, of_design, 0)) == [1, 2, 3]
            assert [event.name for event in events_above(session, own, 0)] == ["running", "done"]
            assert newest_numbers(session, [own, of_design, "job:none"]) == {own: 2, of_design: 3}

    def test_a_unit_that_is_undone_takes_its_numbers_along(self, database, events):
        def unit(session):
            events.note(session, Event(TOPIC, "revision", {}))
            raise Undone

        with pytest.raises(Undone):
            database.write(unit)
        noted(database, events, "revision")
        with database.read() as session:
            assert numbers(events_above(session, TOPIC, 0)) == [1]

    def test_one_event_by_itself_has_its_number(self, database, events):
        written = [
            database.write(lambda session: note_events(session, Event(TOPIC, "revision", {"revision": 7})))
            for _ in range(3)
        ]
        assert [event.number for (event,) in written] == [1, 2, 3]
        with database.read() as session:
            (last,) = events_above(session, TOPIC, 2)
        assert last == Event(TOPIC, "revision", {"revision": 7}, 3)
        assert last.message == {"event": "revision", "revision": 7}

    def test_progress_is_no_row(self, database, events):
        events.publish(progress("meshing"))
        with database.read() as session:
            assert session.scalar(select(func.count()).select_from(EventRow)) == 0

    def test_a_reader_may_go_on_as_long_as_the_next_row_is_kept(self, database, events):
        noted(database, events, *"abc")
        database.write(lambda session: session.execute(delete(EventRow).where(EventRow.number == 1)) and None)
        with database.read() as session:
            kept = [are_events_kept(session, TOPIC, number, 3) for number in range(5)]
        assert kept == [False, True, True, True, False]


class TestListening:
    def test_events_of_a_topic_reach_all_its_subscribers(self, database, events):
        database.write(lambda session: session.add(design("2")))

        async def scene():
            async with following(events) as first, following(events) as second:
                async with following(events, topic="design:2") as other:
                    noted(database, events, "revision")
                    noted(database, events, "current", topic="design:2")
                    return [(await heard(one, 1))[0].name for one in (first, second, other)]

        assert asyncio.run(scene()) == ["revision", "revision", "current"]

    def test_nobody_hears_of_a_unit_that_is_undone(self, database, events):
        def unit(session):
            events.note(session, Event(TOPIC, "lost", {}))
            raise Undone

        async def scene():
            async with following(events) as subscription:
                with pytest.raises(Undone):
                    database.write(unit)
                noted(database, events, "kept")
                return await heard(subscription, 1)

        assert [event.name for event in asyncio.run(scene())] == ["kept"]

    def test_events_come_from_any_thread_in_order(self, database, events):
        async def scene():
            async with following(events) as subscription:
                writers = [
                    threading.Thread(target=lambda: [noted(database, events, "a") for _ in range(10)])
                    for _ in range(8)
                ]
                for writer in writers:
                    writer.start()
                received = await heard(subscription, 80)
                for writer in writers:
                    writer.join()
                return received

        assert numbers(asyncio.run(scene())) == list(range(1, 81))

    def test_what_overtakes_comes_twice_or_never_comes_is_read_in_order(self, database, events):
        quiet = Events(database)  # its notes reach nobody
        noted(database, quiet, *(["a"] * 60))
        with database.read() as session:
            rows = events_above(session, TOPIC, 0)
        shuffled = random.Random(1).sample(rows[:-1], 40) + rows[:7] + rows[-1:]

        async def scene():
            async with following(events) as subscription:
                events.publish(*shuffled)
                return await heard(subscription, 60)

        assert asyncio.run(scene()) == rows

    def test_progress_comes_between(self, database, events):
        async def scene():
            async with following(events) as subscription:
                noted(database, events, "running")
                events.publish(progress("one"))
                noted(database, events, "done")
                events.publish(progress("late"))
                return await heard(subscription, 4)

        assert [event.name for event in asyncio.run(scene())] == ["running", "progress", "done", "progress"]

    def test_closing_ends_subscriptions_present_and_future(self, database, events):
        async def scene():
            async with following(events) as subscription:
                noted(database, events, "running")
                events.close()
                present = [event.name async for event in subscription]
            async with following(events) as late:
                future = [event async for event in late]
            return present, future

        assert asyncio.run(scene()) == (["running"], [])

    def test_nothing_is_kept_of_a_subscriber_that_left(self, events):
        async def scene():
            async with events.subscribe(TOPIC):
                pass
            events.publish(progress("x"))
            return dict(events._topics)

        assert asyncio.run(scene()) == {}


class TestSlowReaders:
    def test_events_that_found_no_room_are_read_from_the_rows(self, database, events):
        async def scene():
            async with following(events) as subscription:
                for _ in range(_ROOM + 50):
                    noted(database, events, "a")
                await turns()
                return await heard(subscription, _ROOM + 50)

        assert numbers(asyncio.run(scene())) == list(range(1, _ROOM + 51))

    def test_nor_does_progress_push_one_out_for_good(self, database, events):
        async def scene():
            async with following(events) as subscription:
                noted(database, events, "done")
                events.publish(*(progress(str(number)) for number in range(_ROOM + 5)))
                await turns()
                return await heard(subscription, 2)

        done, later = asyncio.run(scene())
        assert (done.name, done.number) == ("done", 1)
        assert later.data["text"] == "5"

    def test_who_reads_on_hears_all_while_more_comes(self, database, events):
        """A reader that reads in pieces, with overflows between them, misses none."""
        total = 6 * _ROOM

        async def scene():
            received = []
            async with following(events) as subscription:
                reader = aiter(subscription)
                for _ in range(6):
                    noted(database, events, *(["a"] * _ROOM))
                    await turns()
                    received += [await anext(reader) for _ in range(_ROOM // 2)]
                async with asyncio.timeout(DEADLINE):
                    received += [await anext(reader) for _ in range(total - len(received))]
            return received

        assert numbers(asyncio.run(scene())) == list(range(1, total + 1))


class TestResuming:
    def test_rows_above_the_number_then_what_comes(self, database, events):
        total = PAGE + 30
        noted(database, events, *(["a"] * total))

        async def scene():
            async with events.subscribe(TOPIC) as subscription:
                subscription.resume(20)
                noted(database, events, "live")
                return await heard(subscription, total - 20 + 1)

        received = asyncio.run(scene())
        assert numbers(received) == list(range(21, total + 2))
        assert received[-1].name == "live"

    def test_other_servers_events_are_found_by_looking(self, database, events):
        elsewhere = Events(database)

        async def scene():
            async with following(events) as subscription:
                noted(database, elsewhere, *"abc")
                events.look([TOPIC, "design:other", "job:none"])
                first = await heard(subscription, 3)
                noted(database, elsewhere, *"de")
                noted(database, events, "f")
                events.look()
                events.look()
                noted(database, events, "g")
                return first + await heard(subscription, 4)

        assert "".join(event.name for event in asyncio.run(scene())) == "abcdefg"

    def test_looking_without_listeners_reads_nothing(self, events, monkeypatch):
        monkeypatch.setattr("app.jobs.events.newest_numbers", lambda *given: pytest.fail("it read"))
        events.look()
        events.look(islice([TOPIC], 1))
