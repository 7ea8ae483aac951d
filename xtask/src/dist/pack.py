"""Packs a folder, on every system alike: pack.py FOLDER ARCHIVE (.zip or .tar.gz). The same files give the same archive."""

import gzip
import sys
import tarfile
import zipfile
from pathlib import Path

folder, archive = map(Path, sys.argv[1:])
files = sorted(path for path in folder.rglob("*") if path.is_file())
names = [path.relative_to(folder.parent).as_posix() for path in files]
# Only programs and libraries are executable; Windows does not tell.
modes = [0o755 if path.open("rb").read(4) in (b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe") else 0o644 for path in files]

if archive.suffix == ".zip":
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for path, name, mode in zip(files, names, modes):
            about = zipfile.ZipInfo(name)
            about.compress_type, about.external_attr = zipfile.ZIP_DEFLATED, mode << 16
            packed.writestr(about, path.read_bytes())
else:
    with archive.open("wb") as raw, gzip.GzipFile(filename="", mode="wb", fileobj=raw, mtime=0) as compressed:
        with tarfile.open(fileobj=compressed, mode="w") as packed:
            for path, name, mode in zip(files, names, modes):
                about = tarfile.TarInfo(name)
                about.size, about.mode = path.stat().st_size, mode
                with path.open("rb") as contents:
                    packed.addfile(about, contents)
