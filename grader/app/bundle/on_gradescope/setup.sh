#!/usr/bin/env bash
# Gradescope runs this once, as root, when it builds the image: it makes the virtual environment that grades.
set -euo pipefail

source=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname -- "$source")
cd -- "$root"

# Print the name of a Python that is new enough and can make virtual environments.
find_python() {
  local name
  for name in python3.13 python3.12 python3.11 python3; do
    if "$name" -I -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then
      echo "$name"
      return
    fi
  done
  return 1
}

# Ubuntu 22.04 has Python 3.10 and offers 3.11; where python3 is new enough, only venv is missing.
# The system's own python3 is not changed: Gradescope runs on it.
install_python() {
  local wanted=(python3.11 python3.11-venv)
  if python3 -I -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then
    wanted=(python3-venv)
  fi
  export DEBIAN_FRONTEND=noninteractive
  apt-get update --quiet && apt-get install --yes --quiet --no-install-recommends "${wanted[@]}"
}

if ! python=$(find_python); then
  echo "setup.sh: found no Python 3.11 or newer with venv; installing one"
  install_python || true
  python=$(find_python) || {
    echo "setup.sh: could not install Python 3.11 or newer. Choose a newer base image, such as Ubuntu 22.04 or 24.04," \
      "or install Python 3.11 and its venv in this script, above this line." >&2
    exit 1
  }
fi
echo "setup.sh: $("$python" --version)"

"$python" -I -m venv --clear venv
venv/bin/python -I -m pip install --disable-pip-version-check --no-cache-dir --progress-bar off --prefer-binary \
  --requirement source/requirements.txt
packages=$(venv/bin/python -I -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
echo "$source" >"$packages/autograder.pth"
venv/bin/python -I -m compileall -q source/grader

# Fail this build if the grader does not run, rather than the first submission.
venv/bin/python -I -m grader --version
venv/bin/python -I source/autograder.py --check
echo "setup.sh: the grader is ready"
