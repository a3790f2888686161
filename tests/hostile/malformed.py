"""Malformed scene files, made from good ones: every case is a small folder with one file to open."""
import gltf_cases
import large_files
import mesh_cases
import reference_cases
from cases import CASES, GOOD, PIPE, Link, case  # some for run.py


def memory():
    for name, extension, content, others, is_good in large_files.FILES:
        case("large-" + name, content, extension, **others)
        if is_good:
            GOOD.add(CASES[-1][0])


def unknown_files():
    case("scene", b"whatever", "fbx")
    case("scene", b"whatever", "")


gltf_cases.make()
reference_cases.make()
mesh_cases.make()
memory()
unknown_files()
