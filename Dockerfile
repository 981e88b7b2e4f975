# docker build --tag grader . && docker run --rm --network none --user "$(id -u)" --volume "$PWD:/work" grader grade my_robot.urdf
FROM python:3.13-slim AS build
COPY . /source
RUN pip wheel --quiet --no-cache-dir --wheel-dir /wheels '/source[documents]'

FROM python:3.13-slim
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels pip install --quiet --no-cache-dir --no-index --find-links /wheels 'urdf-grader[documents]'
WORKDIR /work
USER nobody
ENTRYPOINT ["grader"]
