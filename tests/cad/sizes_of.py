"""The sizes of a solid with their faces, before it is written."""

from cad.surfaces import Size, look


def sizes_of(model):
    """Return the sizes with their faces, by parameter, and the count of faces of each part."""
    parts = model.build()
    seen = {part.name: look(part.solid, len(part.places), part.name) for part in parts}
    sizes = {name: size for name, size in model.dimensions(seen).items() if isinstance(size, Size)}
    return sizes, [len(part.solid.Faces()) for part in parts]
