"""A server that replays a session of CREOSON: it expects the recorded calls in their order, and answers them.

The session was written after CREOSON's documentation and source (3.0.1), not recorded from a licensed Creo.
What Creo calculates in it, volume and STEP file, follows here from the values that were set.
"""

import json
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from math import pi
from pathlib import Path

from cadquery import Solid, Workplane, exporters

RECORDED = json.loads(Path(__file__).with_name("creo_session.json").read_text(encoding="utf-8"))
WALL, WIDTH = 2.5, 25.0  # of the bearing that Creo has [mm]


class Replay:
    """The state of the server: calls that came, values that were set, and what shall go wrong."""

    def __init__(self, folder):
        self.folder, self.calls, self.strange = Path(folder), [], []
        self.values = {"BORE": 50.0, "SCALE": 1.0}
        self.wrong = {}  # answers in place of the recorded ones, by function
        self.lock, self.sessions, self.most = threading.Lock(), 0, 0

    def answer(self, request):
        """The answer to a call, as text."""
        function = request["function"]
        recorded = self._recorded(request)
        with self.lock:
            self.calls.append((request["command"], function))
            if recorded is None:
                self.strange.append(request)
            self.sessions += {"connect": 1, "disconnect": -1}.get(function, 0)
            self.most = max(self.most, self.sessions)
        if function in self.wrong:
            return self.wrong[function]
        answer = json.loads(json.dumps(recorded or {"status": {"error": True, "message": "not recorded"}}))
        data = request.get("data", {})
        if function == "set":
            self.values[data["name"]] = data["value"]
        if function == "massprops":
            answer["data"]["volume"] = self.volume()
        if function == "export_file":
            if len(Path(data["filename"]).stem) > 31:  # as `JlinkUtils.validateFilename` says
                message = "File name must be less than 32 characters before the extension"
                return json.dumps({"status": {"error": True, "message": message}, "data": None})
            answer["data"]["filename"] = data["filename"]
            (self.folder / data["filename"]).write_bytes(self.step())
        return json.dumps(answer)

    def _recorded(self, request):
        data = request.get("data", {})
        for one in RECORDED:
            wanted = one["request"]
            fixed = {key: value for key, value in wanted.get("data", {}).items() if key != "value"}
            if (wanted["command"], wanted["function"]) == (request["command"], request["function"]):
                if all(data.get(key) == value for key, value in fixed.items()):
                    return one["answer"]
        return None

    def volume(self):
        bore = self.values["BORE"] * self.values["SCALE"]
        return pi / 4 * ((bore + 2 * WALL) ** 2 - bore**2) * WIDTH

    def step(self):
        bore = self.values["BORE"] * self.values["SCALE"]
        ring = Solid.makeCylinder(bore / 2 + WALL, WIDTH).cut(Solid.makeCylinder(bore / 2, WIDTH))
        place = self.folder / "drawn.step"
        exporters.export(Workplane(ring), str(place), exporters.ExportTypes.STEP)
        return place.read_bytes()


@contextmanager
def creoson(folder):
    """A replay behind an address."""
    replay = Replay(folder)

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            text = replay.answer(json.loads(body)).encode()
            self.send_response(200)
            self.send_header("Content-Length", str(len(text)))
            self.end_headers()
            self.wfile.write(text)

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    try:
        replay.url = f"http://127.0.0.1:{server.server_port}/creoson"
        yield replay
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
