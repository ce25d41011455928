"""A stop signal acts at once and then as the server handles it; later signals are the server's again."""

import asyncio
import signal
import threading
from contextlib import closing

import pytest
from patience import patient

from app.http.server import on_stop_signal


@pytest.fixture
def handled():
    """Signals that the server's own handler receives, one after the other."""
    numbers = []

    def handler(number, frame):
        numbers.append(number)

    before = {number: signal.signal(number, handler) for number in (signal.SIGINT, signal.SIGTERM)}
    yield numbers
    for number, old in before.items():
        signal.signal(number, old)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_acts_and_reaches_the_server(handled, number):
    async def serve():
        acted = asyncio.Event()
        with on_stop_signal(acted.set):
            signal.raise_signal(number)
            assert handled == [number]
            assert not acted.is_set()  # not in the handler, which may interrupt whoever holds a lock
            await asyncio.wait_for(acted.wait(), patient(60))
        acted.clear()
        signal.raise_signal(number)
        await asyncio.sleep(0)
        assert not acted.is_set()

    with closing(asyncio.new_event_loop()) as loop:  # asyncio.run has a handler of SIGINT of its own
        loop.run_until_complete(serve())
    assert handled == [number, number]


def test_a_server_in_a_thread_leaves_the_signals_alone(handled):
    async def serve():
        before = signal.getsignal(signal.SIGTERM)
        with on_stop_signal(lambda: None):
            return signal.getsignal(signal.SIGTERM) is before

    unchanged = []
    thread = threading.Thread(target=lambda: unchanged.append(asyncio.run(serve())))
    thread.start()
    thread.join()
    assert unchanged == [True]
