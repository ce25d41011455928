"""Import Pint without Dask: import this module before all that imports Pint.

Where Dask is installed, Pint imports it, for arrays that neither the commands of the shell nor the server
have, and that takes longer than Pint itself. Dask cannot hold the quantities of such a Pint, so a notebook
imports Pint as it is. A server of a team hands Dask packed bytes only.
"""

from __future__ import annotations

from app.alone import import_alone

import_alone("pint", without="dask")
