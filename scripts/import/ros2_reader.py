"""ROS 2 bags in SQLite (.db3): messages in CDR, of common types or with their definitions."""

import os
import pathlib
import sqlite3

import cdr
import message_tables
from errors import BadInput
from limits import LEAST_UNPACKED


def _refuse_cut(path):
    """SQLite reads a page that the file has not got as zeros."""
    with open(path, "rb") as file:
        header = file.read(100)
    if len(header) < 100:
        raise BadInput(f"{path}: broken or cut: shorter than the header of SQLite")
    page, pages = int.from_bytes(header[16:18], "big"), int.from_bytes(header[28:32], "big")
    if os.path.getsize(path) < (65536 if page == 1 else page) * pages:
        raise BadInput(f"{path}: broken or cut: shorter than its header says")


def read(path):
    _refuse_cut(path)
    # A bag that is still written to has a journal beside it, and SQLite reads that too.
    connection = sqlite3.connect(pathlib.Path(path).resolve().as_uri() + "?mode=ro", uri=True)
    try:
        # A generated column may be of any length, and no cell of the file is longer than it.
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, os.path.getsize(path) + LEAST_UNPACKED)
        connection.execute("PRAGMA trusted_schema = OFF")
        fault = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
        if fault != "ok":
            raise BadInput(f"{path}: broken or cut: {fault.splitlines()[-1]}")
        return _tables(path, connection)
    finally:
        connection.close()


def _blob(data):
    """A column of SQLite holds whatever was put there, and bytes(12) are zeros."""
    if not isinstance(data, bytes):
        raise ValueError("a message is no blob")
    return data


def _tables(path, connection):
    definitions, topics = cdr.Definitions(), message_tables.Topics()
    # Rows of views and virtual tables are not in the file, and may have no end.
    names = {row[0] for row in connection.execute(
        "SELECT name FROM sqlite_master WHERE type = 'table' AND rootpage > 0")}
    if not {"topics", "messages"} <= names:
        raise BadInput(f"{path}: is an SQLite file, but no ROS 2 bag: it has no topics and "
                       "messages")
    if "message_definitions" in names:
        for kind, encoding, text in connection.execute(
                "SELECT topic_type, encoding, encoded_message_definition "
                "FROM message_definitions"):
            if encoding == "ros2msg" and isinstance(kind, str) and isinstance(text, str):
                definitions.add(kind, text)
    types = {}
    for identity, topic, kind, form in connection.execute(
            "SELECT id, name, type, serialization_format FROM topics ORDER BY id"):
        types[identity] = topic, kind
        if form != "cdr":
            topics.leave_out(topic, f"is in {form}, not in CDR")
    for identity, stamp, data in connection.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY id"):
        topic, kind = types.get(identity, (None, None))
        if topic is not None:
            topics.add(topic, stamp, lambda: cdr.decode(_blob(data), kind, definitions))
    return topics.tables(path)
