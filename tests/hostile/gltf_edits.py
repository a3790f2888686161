"""The good glTF document with something changed in it."""
import copy
import struct

import good_files as good
from cases import case

DOCUMENT, DATA = good.gltf()


def edited(edit=None, data=DATA):
    document = copy.deepcopy(DOCUMENT)
    if edit is not None:
        edit(document)
    return document, data


def gltf(name, edit=None, data=DATA, **others):
    case(name, good.gltf_text(*edited(edit, data)), "gltf", **others)


def gltf_at(name, path, value):
    """One value of the document replaced; a path ends in a key or an index."""
    def edit(document):
        at = document
        for part in path[:-1]:
            at = at[part]
        at[path[-1]] = value
    gltf(name, edit)


def accessor_of(attribute, mesh=0):
    return DOCUMENT["meshes"][mesh]["primitives"][0]["attributes"][attribute]


def data_with(accessor, numbers, code="f", at=0):
    """The buffer with numbers in an accessor's place."""
    view = DOCUMENT["bufferViews"][DOCUMENT["accessors"][accessor]["bufferView"]]
    new = struct.pack("<%d%s" % (len(numbers), code), *numbers)
    start = view["byteOffset"] + at
    return DATA[:start] + new + DATA[start + len(new):]
