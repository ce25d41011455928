"""News reach those who listen, in order, and never hold up those who tell."""

import asyncio
import threading

from app.jobs.events import _ROOM, Events


def test_events_of_a_topic_reach_all_its_subscribers():
    async def scene():
        events = Events()
        async with events.subscribe("job:1") as first, events.subscribe("job:1") as second:
            async with events.subscribe("job:2") as other:
                events.publish("job:1", {"event": "running"})
                events.publish("job:2", {"event": "done"})
                return [await anext(first), await anext(second), await anext(other)]

    assert [event["event"] for event in asyncio.run(scene())] == ["running", "running", "done"]


def test_events_come_from_any_thread_in_order():
    async def scene():
        events = Events()
        async with events.subscribe("job:1") as heard:
            thread = threading.Thread(
                target=lambda: [events.publish("job:1", {"event": number}) for number in range(50)]
            )
            thread.start()
            received = [(await anext(heard))["event"] for _ in range(50)]
            thread.join()
            return received

    assert asyncio.run(scene()) == list(range(50))


def test_a_slow_reader_loses_the_oldest():
    async def scene():
        events = Events()
        async with events.subscribe("job:1") as heard:
            for number in range(_ROOM + 5):
                events.publish("job:1", {"event": number})
            await asyncio.sleep(0)  # one turn of the loop, which hands over all of them
            return (await anext(heard))["event"]

    assert asyncio.run(scene()) == 5


def test_closing_ends_subscriptions_present_and_future():
    async def scene():
        events = Events()
        async with events.subscribe("job:1") as heard:
            events.publish("job:1", {"event": "running"})
            events.close()
            present = [event async for event in heard]
        async with events.subscribe("job:1") as late:
            future = [event async for event in late]
        return present, future

    assert asyncio.run(scene()) == ([{"event": "running"}], [])


def test_nothing_is_kept_of_a_subscriber_that_left():
    async def scene():
        events = Events()
        async with events.subscribe("job:1"):
            pass
        events.publish("job:1", {"event": "done"})
        return dict(events._subscribers)

    assert asyncio.run(scene()) == {}
