"""A service that requires keys, with a principal of each role; and a helper that acts as one of them."""

from contextlib import contextmanager
from dataclasses import dataclass

import httpx
from serving import folder_of_models, serving

from app.client import Client
from app.identity.principal import ROLES
from app.settings import Settings


@dataclass
class Team:
    """A service, and the principals and keys by role; `author2` is another author."""

    server: object
    principals: dict
    keys: dict

    @property
    def identity(self):
        return self.server.app.state.services.identity

    def client(self, role):
        return Client(self.server.url, key=self.keys[role])

    def http(self, role=None, **options):
        headers = {"Authorization": f"Bearer {self.keys[role]}"} if role else {}
        headers |= options.pop("headers", {})
        return httpx.Client(base_url=self.server.url, timeout=90, trust_env=False, headers=headers, **options)


@contextmanager
def service_with_roles(folder):
    """A service that asks for keys; its principals are named by their roles."""
    models = (folder_of_models(folder / "templates"),)
    with serving(Settings(data=folder / "data", template_folders=models)) as server:
        identity = server.app.state.services.identity
        principals, keys = {}, {}
        for name in (*ROLES, "author2"):
            row = identity.add(name, [name.removesuffix("2")])
            principals[name], keys[name] = row.id, identity.add_key(row.id, "test")[0].text
        yield Team(server, principals, keys)
