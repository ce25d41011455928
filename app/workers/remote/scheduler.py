"""The program of `crankwright scheduler`: Dask's scheduler without retries and web pages.

It holds nothing that must survive a crash, because the queue of jobs is in the database.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import sys

from distributed import Scheduler

from app.settings import Settings
from app.workers.remote.network import configure, security


async def _run(settings: Settings, host: str, port: int) -> None:
    stopping = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, stopping.set)
    protocol = "tcp" if settings.dask_ca is None else "tls"
    scheduler = Scheduler(
        host=host,
        port=port,
        protocol=protocol,
        security=security(settings),
        dashboard=False,
        dashboard_address="127.0.0.1:0",
    )
    async with scheduler:
        logging.getLogger(__name__).warning("scheduler at %s", scheduler.address)
        await stopping.wait()


def main() -> None:
    """Run the scheduler on the host and port at the end of the command line."""
    logging.basicConfig(format="%(asctime)s %(message)s")
    configure()
    asyncio.run(_run(Settings(), sys.argv[-2], int(sys.argv[-1])))
