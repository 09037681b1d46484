# The README's own steps in an image; the data live in the volume /data.
FROM python:3.12-slim
WORKDIR /servoident
COPY . .
RUN python3 -c "from app.environment import prepare; prepare('requirements.lock')" \
    && useradd --create-home servoident && mkdir /data && chown -R servoident /data
USER servoident
VOLUME /data
ENV PATH="/servoident/.venv/bin:$PATH"
EXPOSE 8000
HEALTHCHECK --start-period=60s --timeout=5s CMD ["python3", "-c", \
    "from urllib.request import urlopen; urlopen('http://127.0.0.1:8000/api/v1/health', timeout=4)"]
CMD ["servoident", "serve", "--host", "0.0.0.0", "--data", "/data"]
