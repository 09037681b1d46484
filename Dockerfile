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
CMD ["servoident", "serve", "--host", "0.0.0.0", "--data", "/data"]
