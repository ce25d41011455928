"""A typed client of the REST interface, built on httpx. It returns the models of `app.schemas`.

with Client("http://127.0.0.1:8000") as client:
    answer = client.evaluate("oil_film", 1, {"radial_load": "25 kN", …})
    thickness = answer.outputs["minimum_film_thickness"].value
    design = client.create({"name": "main bearing", …})
    design = client.change(design, {"parameters": {"scale": "1.02"}})
    path = client.download(design.id, "step").save()  # main_bearing_model_r2.step

Every call waits for its result, even if the service starts a job for it. `AsyncClient` has the same methods
as coroutines.
"""

from app.client.clients import AsyncClient, Client
from app.client.exchange import Progress
from app.client.files import File
from app.client.names import CLIENT_HEADER, user_at_host
from app.client.problem import Problem

__all__ = ["CLIENT_HEADER", "AsyncClient", "Client", "File", "Problem", "Progress", "user_at_host"]
