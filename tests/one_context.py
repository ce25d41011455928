"""One TLS context for all HTTP clients of a process, because reading the certificate authorities takes 20 ms.

Tests make thousands of clients, and none of them speaks TLS with a stranger. A client that asks for a context
of its own gets one.
"""

import os
from collections.abc import Callable
from ssl import SSLContext
from typing import Any

from httpx._transports import default

NAMES = ("SSL_CERT_FILE", "SSL_CERT_DIR")  # what httpx reads of the environment


def share_one_context(create: Callable[..., SSLContext] = default.create_ssl_context) -> None:
    """Have clients of httpx that verify as usual share a context, one for each setting of the environment."""
    contexts: dict[Any, SSLContext] = {}

    def shared(verify: Any = True, cert: Any = None, trust_env: bool = True) -> SSLContext:
        if verify is not True or cert is not None:
            return create(verify=verify, cert=cert, trust_env=trust_env)
        key = trust_env and tuple(map(os.environ.get, NAMES))
        if key not in contexts:
            contexts[key] = create(trust_env=trust_env)
        return contexts[key]

    default.create_ssl_context = shared
