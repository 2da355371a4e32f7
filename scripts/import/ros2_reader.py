"""ROS 2 bags in SQLite (.db3): messages in CDR, of common types or with their definitions."""

import os
import pathlib
import sqlite3

import cdr
import message_tables
from errors import BadInput


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
        fault = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
        if fault != "ok":
            raise BadInput(f"{path}: broken or cut: {fault.splitlines()[-1]}")
        return _topics(path, connection)
    finally:
        connection.close()


def _topics(path, connection):
    definitions = cdr.Definitions()
    names = {row[0] for row in connection.execute("SELECT name FROM sqlite_master")}
    if not {"topics", "messages"} <= names:
        raise BadInput(f"{path}: is an SQLite file, but no ROS 2 bag: it has no topics and "
                       "messages")
    if "message_definitions" in names:
        for kind, encoding, text in connection.execute(
                "SELECT topic_type, encoding, encoded_message_definition "
                "FROM message_definitions"):
            if encoding == "ros2msg":
                definitions.add(kind, text)
    topics, left_out = {}, []
    for identity, topic, kind, form in connection.execute(
            "SELECT id, name, type, serialization_format FROM topics ORDER BY id").fetchall():
        if form != "cdr":
            left_out.append(f"{topic} is in {form}, not in CDR")
            continue
        try:
            topics[topic] = [
                (stamp, cdr.decode(bytes(data), kind, definitions))
                for stamp, data in connection.execute(
                    "SELECT timestamp, data FROM messages WHERE topic_id = ? "
                    "ORDER BY timestamp, id", (identity,))]
        except cdr.UnknownType as unknown:
            topics.pop(topic, None)
            left_out.append(f"{topic} needs the definition of {unknown}, which the bag lacks")
    if not topics and left_out:
        raise BadInput(f"{path}: no topic can be read: {'; '.join(left_out)}")
    return message_tables.tables(path, {t: m for t, m in topics.items() if m}, left_out)
