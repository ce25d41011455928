"""The work that begins as soon as the server receives a signal to stop.

uvicorn waits for open responses before it runs the end of the lifespan, so a stream of events would keep it
from stopping. The signal itself has to end the streams, and to keep new jobs from being begun.
"""

import asyncio
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def on_stop_signal(act: Callable[[], None]) -> Iterator[None]:
    """Act at SIGINT and SIGTERM, then do what the server does; for use within its lifespan."""
    if threading.current_thread() is not threading.main_thread():  # a server in a thread gets no signals
        yield
        return
    loop = asyncio.get_running_loop()
    previous = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def close(number: int, frame: FrameType | None) -> None:
        loop.call_soon_threadsafe(act)  # not here: a handler may interrupt who holds the lock
        handler = previous[signal.Signals(number)]
        if callable(handler):
            handler(number, frame)

    for number, handler in previous.items():
        if callable(handler):
            signal.signal(number, close)
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
