"""Tables as programs of other makers read them: pandas, Polars and DuckDB have the Parquet file to the bit as the CSV and the NumPy
array of the same run have it, with their types and with what is known about the table.

    python tests/parquet_readers.py target/release/linkwear

needs pandas, pyarrow, polars, duckdb."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pyarrow.parquet as pq

RUN = ["simulate", "mechanisms/slider_crank_clearance.toml", "--samples", "150000", "--time", "0.01", "--out"]


def bits(values):
    return np.ascontiguousarray(values, dtype="<f8").view("<u8")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        parquet, csv, npy = (Path(folder, f"rows.{end}") for end in ("parquet", "csv", "npy"))
        for file in (parquet, csv, npy):
            subprocess.run([program, *RUN, file], check=True, stdout=subprocess.DEVNULL)
        own, text = np.load(npy), pd.read_csv(csv)
        titles = list(text.columns)
        con = duckdb.connect()
        query = con.execute(f"select * from '{parquet}'")
        readers = {
            f"pandas {pd.__version__}": pd.read_parquet(parquet),
            f"Polars {pl.__version__}": pl.read_parquet(parquet),
            f"DuckDB {duckdb.__version__}": query.fetchnumpy(),
        }
        for reader, table in readers.items():
            names = list(table.keys() if isinstance(table, dict) else table.columns)
            assert names == titles == list(own.dtype.names), (reader, names)
            for title in titles:
                values = np.asarray(table[title])
                assert values.dtype == np.float64, (reader, title, values.dtype)
                assert (bits(values) == bits(own[title])).all(), (reader, title)
                # Text has no negative zero.
                assert (bits(values + 0.0) == bits(text[title])).all(), (reader, title)
            print(f"{reader}: {len(titles)} columns of {len(own)} rows to the bit")
        metadata = pq.ParquetFile(parquet).metadata
        assert metadata.num_row_groups == 2 and metadata.created_by.startswith("linkwear version "), metadata
        known = json.loads(metadata.metadata[b"linkwear"])
        beside = json.loads(Path(f"{csv}-metadata.json").read_text())
        assert known["columns"] == beside["tableSchema"]["columns"] and known["provenance"] == beside["notes"][0]["provenance"]
        assert [column["titles"] for column in known["columns"]] == titles
        print(f"metadata: {known['provenance']['version']}, {known['columns'][1]}")


if __name__ == "__main__":
    main(sys.argv[1])
