"""The documentation site: pages that MkDocs writes from the code when it builds `docs/`.

`mkdocs build --strict` runs `mkdocs_hooks.py`. A page is written here if the code says what stands on it: each
template and model, the language, the REST interface, the client, the map of the code, the list of decisions.
"""
