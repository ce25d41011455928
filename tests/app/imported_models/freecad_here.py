"""Import and draw models of FreeCAD in this process, without a service."""

import hashlib
import threading
from types import SimpleNamespace

from app.imported_models.descriptions import described_freecad
from app.imported_models.freecad import find
from app.imported_models.programs import FreeCadDrawing, values_of
from app.workers.base import Limits
from cad.model_classes import class_of
from cad.regenerate import as_text, regenerate_shape


class Store(dict):
    """Artifacts in memory."""

    def put(self, content):
        sha = hashlib.sha256(content).hexdigest()
        self[sha] = content
        return sha

    def read(self, sha):
        return self[sha]


class Context:
    """A job that runs its functions at once."""

    cancelled = threading.Event()

    def progress(self, done, what):
        pass

    def run(self, function, *args, limits=None):
        return function(*args)


class FreeCadHere:
    """FreeCAD with a store; ended by `close`."""

    def __init__(self):
        self.store = Store()
        self.freecad = FreeCadDrawing(self.store, find, Limits(120.0, 4096))

    def described(self, content, id="part"):
        programs = SimpleNamespace(freecad=self.freecad)
        return described_freecad(content, id, f"{id}.FCStd", self.store, programs, Context())

    def built(self, described, **values):
        shape = class_of(described.text, "part", 1).from_quantities(values)
        shape.take(self.freecad.draw(described, values_of(shape), Context.cancelled))
        return regenerate_shape(shape, as_text(shape))

    def close(self):
        self.freecad.warm.close()
