"""A server that accepts connections and does not answer, on a port that another server may use later."""

import socket
import threading
from contextlib import suppress


class Silence:
    """Accepts connections on a port of loopback, says what it is given, and then nothing more."""

    def __init__(self, port=0, said=b""):
        self._said = said
        self._listening = socket.create_server(("127.0.0.1", port))
        self.port = self._listening.getsockname()[1]
        self.held: list[socket.socket] = []
        self._thread = threading.Thread(target=self._accept, name="silence", daemon=True)
        self._thread.start()

    def end(self):
        """Break all connections and free the port."""
        with suppress(OSError):
            self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self._thread.join()
        for one in self.held:
            one.close()

    def _accept(self):
        with suppress(OSError):
            while True:
                connection = self._listening.accept()[0]
                self.held.append(connection)
                if self._said:
                    connection.recv(2**16)  # a request, which must come first
                    connection.sendall(self._said)
