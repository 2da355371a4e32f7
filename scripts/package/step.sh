# Sourced by scripts that go through steps: `step NAME COMMAND...` runs a command in a
# shell of its own, without standard input, and prints its name and time; of one that
# fails it prints all and ends the script. Needs the folder $work for its output.
step() {
  local name=$1 start=$SECONDS code=0
  shift
  # In a condition `set -e` would not hold inside the command.
  set +e
  (set -e; "$@") </dev/null >"$work/step.log" 2>&1
  code=$?
  set -e
  if ((code != 0)); then
    cat "$work/step.log" >&2
    echo "FAILED with $code: $name" >&2
    exit 1
  fi
  printf '%4d s  %s\n' $((SECONDS - start)) "$name"
}
