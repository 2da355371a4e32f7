# A stand-in: its headers are those of the folder beside.
