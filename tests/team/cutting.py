"""A proxy between a client and an S3 server that breaks connections or stops answering for a test."""

import socket
import threading
from contextlib import suppress


class Cutter:
    """Passes bytes on. After `most` bytes of answers, if that is set, a connection breaks.

    Unless `speaking` is set, answers wait.
    """

    def __init__(self, endpoint: str) -> None:
        self._target = int(endpoint.rpartition(":")[2])
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"http://127.0.0.1:{self._listening.getsockname()[1]}"
        self.most = None
        self.speaking = threading.Event()
        self.speaking.set()
        self.cuts = 0
        threading.Thread(target=self._serve, daemon=True).start()

    def close(self) -> None:
        self.speaking.set()
        self._listening.close()

    def _serve(self) -> None:
        with suppress(OSError):
            while True:
                client, _ = self._listening.accept()
                server = socket.create_connection(("127.0.0.1", self._target))
                threading.Thread(target=self._pass, args=(client, server, False), daemon=True).start()
                threading.Thread(target=self._pass, args=(server, client, True), daemon=True).start()

    def _pass(self, source: socket.socket, target: socket.socket, is_answer: bool) -> None:
        passed = 0
        with suppress(OSError), source, target:
            while data := source.recv(2**16):
                if is_answer:
                    self.speaking.wait()
                if is_answer and self.most is not None and passed + len(data) > self.most:
                    target.sendall(data[: self.most - passed])
                    self.cuts += 1
                    break
                target.sendall(data)
                passed += len(data)
            for one in (source, target):
                one.shutdown(socket.SHUT_RDWR)
