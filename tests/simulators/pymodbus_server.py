"""An independent Modbus server for the driver's tests: a cup (slave 1, register 0) and a vane (slave 2, registers 0 and 1).

usage: pymodbus_server.py tcp|SERIAL_PORT SPEED_TENTHS DIRECTION_DEG

Says "listening on PORT" (TCP, a free port) or "listening on SERIAL_PORT" when it can be asked.
"""
import asyncio
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer
from pymodbus.transaction import ModbusRtuFramer


def device(registers):
    return ModbusSlaveContext(hr=ModbusSequentialDataBlock(0, registers), zero_mode=True)


async def main():
    where, speed_tenths, direction_deg = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    context = ModbusServerContext(single=False, slaves={1: device([speed_tenths]),
                                                        2: device([round(direction_deg / 45) % 8, direction_deg])})
    if where == "tcp":
        server = ModbusTcpServer(context, address=("127.0.0.1", 0))
        task = asyncio.create_task(server.serve_forever())
        await server.serving
        print("listening on", server.server.sockets[0].getsockname()[1], flush=True)
    else:
        server = ModbusSerialServer(context, framer=ModbusRtuFramer, port=where, baudrate=4800)
        await server.start()
        task = asyncio.create_task(server.serve_forever())
        print("listening on", where, flush=True)
    await task


asyncio.run(main())
