"""The fork servers that `crankwright serve` forks from itself, once it has imported the service.

They share the pages of what it has imported, and import nothing again: that of jobs loads the kernel while
the server opens its data, those of calculations and checks are ready at once and need hardly any memory.
"""

from __future__ import annotations

from app.assembly import NETWORK, SHEETS
from app.calculations.assembly import PRELOAD
from app.catalogue.finding import find_templates
from app.machines import LOCAL
from app.settings import Settings
from app.workers import ahead
from app.workers.light import CHECKS
from app.workers.local import KERNEL
from cad import on_demand
from cad.catalogue import models


def fork_ahead(settings: Settings) -> None:
    """Fork what a service with these settings will ask for; call it before there is a thread or a connection.

    The built-in templates and models are imported first, so that the processes have them as well.

    Raises
    ------
    UnusableFile
        If one of them cannot be used.
    """
    find_templates(())
    models()
    if settings.engine == LOCAL:
        ahead.fork(KERNEL, on_demand.load)
    if settings.template_folders:
        ahead.fork(CHECKS)
    ahead.fork((*PRELOAD, *SHEETS, *NETWORK))
