"""The documentation site: pages that MkDocs writes from the code when it builds `docs/`.

`mkdocs build --strict` runs `docs/hooks.py`. Each module writes pages from the
code: those of templates and models, the language, the REST interface, the client, the map of the code, the
index of the decisions, the executed notebooks.
"""
