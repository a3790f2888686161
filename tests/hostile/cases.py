"""The cases: what each folder holds. Filled by the modules beside this one."""
import re

CASES = []  # (name, {file name: content, or what makes it}); the first file is the one to open
GOOD = set()  # names of those that nothing is wrong with: they must render without a word


class Link(str):
    """A file that is a symbolic link, to this."""


PIPE = object()  # a file that is a pipe which nobody writes into


def case(name, content, extension, **others):
    files = {"scene." + extension: content}
    files.update({key.replace("__", "."): value for key, value in others.items()})
    name = re.sub(r"[^A-Za-z0-9_.+^-]", "_", name)[:60]
    CASES.append(("%s-%03d-%s" % (extension or "none", len(CASES), name), files))
