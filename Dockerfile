# SPDX-License-Identifier: BSD-2-Clause
# The programs for systems other than Debian: docker build -t adcgs . && docker run --rm -v "$PWD:/data" adcgs info my.adcgs
FROM debian:12-slim AS build
COPY . /src/adcgs
WORKDIR /src/adcgs
RUN apt-get update && apt-get install -y --no-install-recommends build-essential && \
    apt-get build-dep -y --no-install-recommends ./ && DEB_BUILD_OPTIONS=nocheck dpkg-buildpackage -b -us -uc

FROM debian:12-slim
COPY --from=build /src/adcgs-tools_*.deb /tmp/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/adcgs-tools_*.deb && \
    rm -rf /tmp/adcgs-tools_*.deb /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["adcgs"]
