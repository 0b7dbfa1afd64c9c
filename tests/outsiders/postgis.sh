#!/bin/bash
# postgis.sh MANSARD DATA WORK: writes buildings to a database twice, in a server of its own. Exits with 77, which skips the
# test, where PostgreSQL or PostGIS are not installed: [postgis] in packages.txt.
set -euo pipefail
mansard=$1 data=$2 work=$3
bin=$(ls -d /usr/lib/postgresql/*/bin 2>/dev/null | sort -V | tail -1 || true)
[ -n "$bin" ] && [ -x "$bin/initdb" ] || { echo "PostgreSQL is not installed"; exit 77; }
version=$(basename "$(dirname "$bin")")
[ -e "/usr/share/postgresql/$version/extension/postgis.control" ] || { echo "PostGIS is not installed"; exit 77; }
rm -rf "$work"; mkdir -p "$work"
folder=$(mktemp -d /tmp/mansard-postgis-XXXXXX)   # the path of a socket has at most 107 bytes
as=()
if [ "$(id -u)" = 0 ]; then  # the server refuses to run as root
  id postgres >/dev/null 2>&1 || { echo "there is no user postgres"; exit 77; }
  chown postgres "$folder"
  as=(runuser -u postgres --)
fi
cd "$folder"
clean() { "${as[@]}" "$bin/pg_ctl" -D "$folder/db" -m immediate stop >/dev/null 2>&1 || true; rm -rf "$folder"; }
trap clean EXIT
"${as[@]}" "$bin/initdb" -D "$folder/db" -A trust -U tester >"$work/initdb.log"
"${as[@]}" "$bin/pg_ctl" -D "$folder/db" -w -t 120 -l "$folder/log" -o "-k $folder -c listen_addresses='' -c fsync=off" start >/dev/null
sql() { "${as[@]}" "$bin/psql" -h "$folder" -U tester -d "${db:-city}" -v ON_ERROR_STOP=1 -qAtc "$1"; }
db=postgres sql "CREATE DATABASE city"
sql "CREATE EXTENSION postgis"
sql "CREATE TABLE others (id int); INSERT INTO others VALUES (7)"
address="PG:dbname=city host=$folder user=tester"
fail() { echo "$1"; exit 1; }
expect() { [ "$2" = "$3" ] || fail "$1: expected '$3', found '$2'"; }

"$mansard" extrude "$data/delft/footprints.geojson" -o "$address" -q >"$work/out.txt"
count=$(sql "SELECT count(*) FROM mansard_buildings")
expect "buildings" "$count" 87
expect "solids have all levels" "$(sql "SELECT string_agg(DISTINCT lod, ',' ORDER BY lod) FROM mansard_solids")" "1.2,1.3,2.2"
solids=$(sql "SELECT count(*) FROM mansard_solids")
expect "the coordinate system" "$(sql "SELECT DISTINCT ST_SRID(geom) FROM mansard_solids")" 28992
# Edges that are not those of two faces. ST_IsClosed of PostGIS 3.3 is not asked: it denies it of boxes for which this finds none.
expect "open edges" "$(sql "SELECT count(*) FROM (SELECT id FROM (SELECT fid id, LEAST(ST_AsText(p), ST_AsText(n)) a, GREATEST(ST_AsText(p), ST_AsText(n)) b
  FROM (SELECT fid, geom p, lead(geom) OVER (PARTITION BY fid, path[1], path[2] ORDER BY path[3]) n
  FROM (SELECT fid, (ST_DumpPoints(geom)).* FROM mansard_solids) d) e WHERE n IS NOT NULL) x GROUP BY id, a, b HAVING count(*) <> 2) y")" 0
expect "invalid footprints" "$(sql "SELECT count(*) FROM mansard_buildings WHERE NOT ST_IsValid(geom)")" 0

# Twice in a row, with a column of somebody else, and one building at another height.
sql "ALTER TABLE mansard_buildings ADD note text; UPDATE mansard_buildings SET note = 'mine'"
"$mansard" extrude "$data/delft/footprints.geojson" -o "$address" --default-height 11 -q >"$work/out.txt"
expect "buildings after an update" "$(sql "SELECT count(*) FROM mansard_buildings")" "$count"
expect "solids after an update" "$(sql "SELECT count(*) FROM mansard_solids")" "$solids"
expect "notes that were lost" "$(sql "SELECT count(*) FROM mansard_buildings WHERE note IS DISTINCT FROM 'mine'")" 0
expect "heights" "$(sql "SELECT DISTINCT round((\"ms_h_roof_max\" - \"ms_h_ground\")::numeric) FROM mansard_buildings")" 11

# Other buildings are added, and those that are there stay.
"$mansard" extrude "$data/hall/footprints.geojson" -o "$address" --crs EPSG:28992 -q >"$work/out.txt"
expect "buildings after others" "$(sql "SELECT count(*) > $count FROM mansard_buildings")" t

# What fails changes nothing.
before=$(sql "SELECT count(*), sum(\"ms_h_roof_max\") FROM mansard_buildings")
sql "ALTER TABLE mansard_buildings ALTER \"ms_volume_lod22\" TYPE int"
if "$mansard" extrude "$data/delft/footprints.geojson" -o "$address" --default-height 4 -q 2>"$work/err.txt"; then
  fail "a column that cannot hold its values was accepted"
fi
grep -q "write-postgis" "$work/err.txt" || fail "$(cat "$work/err.txt")"
expect "a failed run" "$(sql "SELECT count(*), sum(\"ms_h_roof_max\") FROM mansard_buildings")" "$before"
expect "tables of others" "$(sql "SELECT id FROM others")" 7
echo "PostGIS $(sql "SELECT postgis_lib_version()"): $count buildings, $solids solids"
