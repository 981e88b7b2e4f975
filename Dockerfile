# In the checkout: docker build --tag grader .
# In the folder of a robot: docker run --rm --network none --user "$(id -u):$(id -g)" --volume "$PWD:/work" grader grade my_robot.urdf
# The digest is that of the tag's index, for all platforms, as docker-library/repo-info lists it. Dependabot renews it.
FROM python:3.13-slim@sha256:9662417aace5ae7b8e2609cce472b72a8958e134ba372808abe9cc1a0c0125e6
RUN --mount=type=bind,target=/source pip install --quiet --no-cache-dir --require-hashes --requirement /source/requirements.lock
RUN --mount=type=bind,target=/source,rw pip install --quiet --no-cache-dir --no-deps --no-build-isolation /source
WORKDIR /work
USER nobody
ENTRYPOINT ["grader"]
